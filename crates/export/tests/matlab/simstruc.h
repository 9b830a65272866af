/* What the exported S-function asks of Simulink, for one block that is called by main in simulink.c: a stand-in after the
   documentation of the functions of SimStruct, not Simulink. */
#ifndef SIMSTRUC_H
#define SIMSTRUC_H

#include <stddef.h>

typedef double real_T;
typedef int int_T;
typedef const real_T *const *InputRealPtrsType;

typedef struct {
    size_t count;
    real_T value;
} mxArray;

#define PORTS 20
#define MOST_WORK 200

typedef struct {
    int_T inputs;
    int_T outputs;
    int_T parameters;
    int_T widths;
    int_T feedthrough;
    int_T work;
    real_T sample_time;
    const char *error;
    mxArray parameter[2];
    real_T input[PORTS];
    const real_T *input_at[PORTS];
    real_T output[PORTS];
    real_T memory[MOST_WORK];
} SimStruct;

#define mxIsDouble(a) ((a) != NULL)
#define mxIsComplex(a) ((a) == NULL)
#define mxGetNumberOfElements(a) ((a)->count)
#define mxGetScalar(a) ((a)->value)

#define ssSetNumSFcnParams(S, n) ((S)->parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->parameters)
#define ssGetSFcnParamsCount(S) 2
#define ssGetSFcnParam(S, k) (&(S)->parameter[k])
#define ssSetSFcnParamTunable(S, k, on) ((void)(S))
#define ssSetErrorStatus(S, text) ((S)->error = (text))
#define ssGetErrorStatus(S) ((S)->error)
#define ssSetNumContStates(S, n) ((void)(S))
#define ssSetNumDiscStates(S, n) ((void)(S))
#define ssSetNumInputPorts(S, n) (((S)->inputs = (n)) <= PORTS)
#define ssSetNumOutputPorts(S, n) (((S)->outputs = (n)) <= PORTS)
#define ssSetInputPortWidth(S, k, n) ((S)->widths += (n))
#define ssSetOutputPortWidth(S, k, n) ((S)->widths += (n))
#define ssSetInputPortDirectFeedThrough(S, k, on) ((S)->feedthrough += (on))
#define ssSetNumSampleTimes(S, n) ((void)(S))
#define ssSetNumRWork(S, n) ((S)->work = (n))
#define ssSetNumIWork(S, n) ((void)(S))
#define ssSetNumPWork(S, n) ((void)(S))
#define ssSetNumModes(S, n) ((void)(S))
#define ssSetNumNonsampledZCs(S, n) ((void)(S))
#define ssSetSampleTime(S, k, t) ((S)->sample_time = (t))
#define ssSetOffsetTime(S, k, t) ((void)(S))
#define ssGetRWork(S) ((S)->memory)
#define ssGetInputPortRealSignalPtrs(S, k) ((InputRealPtrsType)&(S)->input_at[k])
#define ssGetOutputPortRealSignal(S, k) (&(S)->output[k])

#endif
