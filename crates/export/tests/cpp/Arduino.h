/* Of the Arduino core what the sketches call: text goes out of the first serial port of an ATmega328P. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdio.h>
#include <stdlib.h>

inline unsigned long micros()
{
    static unsigned long time;
    return time += 1000;
}

struct Port {
    void begin(unsigned long) { UCSR0B = static_cast<uint8_t>(1u << TXEN0); }
    void put(char c)
    {
        while (!(UCSR0A & (1u << UDRE0))) {
        }
        UDR0 = static_cast<uint8_t>(c);
    }
    void print(const char *text)
    {
        while (*text != 0) {
            put(*text++);
        }
    }
    void print(unsigned number)
    {
        char text[12];
        print(utoa(number, text, 10));
    }
    void print(unsigned long number)
    {
        char text[12];
        print(ultoa(number, text, 10));
    }
    void print(double number)
    {
        char text[24];
        print(dtostrf(number, 1, 2, text));
    }
    void println(const char *text)
    {
        print(text);
        print("\n");
    }
};

inline Port &port()
{
    static Port first;
    return first;
}

#define Serial port()

void setup();
void loop();

int main()
{
    setup();
    for (int k = 0; k < 3; k++) {
        loop();
    }
    /* that nothing will wake: the simulator ends here */
    cli();
    sleep_mode();
    return 0;
}
