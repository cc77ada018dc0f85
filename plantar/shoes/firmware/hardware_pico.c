/* Raspberry Pi Pico 2 (SC1631) with up to three 16-channel multiplexers CD74HC4067, by the Pico SDK; USB is the port.
 *
 * Rows and bridges: GP0 to GP18. Multiplexers' S0 to S3: GP19 to GP22. Their common pins: columns 0 to 15 at GP26 (ADC0),
 * 16 to 31 at GP27 (ADC1); rows, or columns 32 to 47, at GP28 (ADC2). Of a bridge k DOUT is at GP(k), all PD_SCK at GP19. */
#include "hardware.h"
#include "hardware/adc.h"
#include "hardware/gpio.h"
#include "pico/stdlib.h"

#define SELECT 19
#define SETTLE_US 5 /* ten times the 70 ohm of a multiplexer on 100 pF, and the drivers */
#define PULSES 26   /* 24 bits, and two more: channel B with a gain of 32 */

static int driven_rows;

void hardware_begin(int rows, int columns) {
    (void)columns;
    stdio_init_all();
    adc_init();
    driven_rows = rows;
    for (int pin = 0; pin < SELECT + 4; pin++) {
        gpio_init((unsigned)pin);
        gpio_set_dir((unsigned)pin, pin >= SELECT || rows > 0);
    }
    for (unsigned input = 0; input < 3; input++) adc_gpio_init(26 + input);
}

int hardware_running(void) { return 1; }
uint32_t hardware_time_us(void) { return time_us_32(); }

void hardware_wait_until_us(uint32_t time) {
    while ((int32_t)(time - time_us_32()) > 0) tight_loop_contents();
}

void hardware_drive_row(int row) {
    for (int k = 0; k < driven_rows; k++) gpio_put((unsigned)k, k == row);
    busy_wait_us_32(SETTLE_US);
}

static uint16_t read_channel(unsigned input, int channel) {
    for (unsigned bit = 0; bit < 4; bit++) gpio_put(SELECT + bit, (channel >> bit) & 1);
    adc_select_input(input);
    busy_wait_us_32(SETTLE_US);
    return (uint16_t)(adc_read() << 4);
}

uint16_t hardware_column(int column) { return read_channel((unsigned)column / 16, column % 16); }
uint16_t hardware_row(int row) { return read_channel(2, row); }

int32_t hardware_bridge(int bridge) {
    while (gpio_get((unsigned)bridge)) tight_loop_contents(); /* low where a reading is ready */
    uint32_t bits = 0;
    for (int pulse = 0; pulse < PULSES; pulse++) {
        gpio_put(SELECT, 1);
        busy_wait_us_32(1);
        if (pulse < 24) bits = bits << 1 | gpio_get((unsigned)bridge);
        gpio_put(SELECT, 0);
        busy_wait_us_32(1);
    }
    return (int32_t)(bits << 8) >> 8;
}

void hardware_send(const uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) putchar_raw(bytes[i]);
}

int hardware_receive(void) {
    int byte = getchar_timeout_us(0);
    return byte < 0 ? -1 : byte;
}
