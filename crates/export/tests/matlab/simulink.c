/* Runs a block over samples as Simulink does: its outputs may be asked for more than once, then comes the update. */
#include <stdio.h>
#include <stdlib.h>

static const int order[] = { ORDER };

static SimStruct block;

int main(int count, char **arguments)
{
    double in[11];
    SimStruct *S = &block;
    for (int k = 0; k < 2; k++) {
        S->parameter[k].count = 1;
        S->parameter[k].value = (count > k + 1) ? atof(arguments[k + 1]) : 0.0;
    }
    mdlInitializeSizes(S);
    mdlCheckParameters(S);
    mdlInitializeSampleTimes(S);
    if (S->error != NULL) {
        (void)printf("%s\n", S->error);
        return 0;
    }
    if ((S->widths != S->inputs + S->outputs) || (S->feedthrough != S->inputs) || (S->work > MOST_WORK) || (S->inputs != sizeof order / sizeof *order)) {
        return 2;
    }
    for (int k = 0; k < S->inputs; k++) {
        S->input_at[k] = &S->input[k];
    }
    mdlInitializeConditions(S);
    while (fread(in, sizeof in, 1, stdin) == 1) {
        for (int k = 0; k < S->inputs; k++) {
            /* a reset is where the time is negative */
            S->input[k] = (order[k] < 0) ? (in[0] < 0.0 ? 1.0 : 0.0) : in[order[k]];
        }
        mdlOutputs(S, 0);
        mdlOutputs(S, 0);
        const double out[2] = { S->output[0], 0.0 };
        mdlUpdate(S, 0);
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    mdlTerminate(S);
    return 0;
}
