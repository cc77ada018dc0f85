/* A sole on a PC: a load that steps and rolls over taxels on rows and columns, with every current of that circuit.
 *
 * Environment: SOLE_DEVICE, where bytes go (else to stdout); SOLE_SECONDS, after which it ends; SOLE_FAULTS, a number: 0
 * none, 1 noise and drift, 2 also lost packets and wrong bytes; SOLE_PRESSED, an index of a taxel that alone is pressed. */
#define _DEFAULT_SOURCE
#include "sole.h"
#include "hardware.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define SENSE 1e-3     /* S, a column's resistor to ground: 1 kOhm */
#define DRIVER 25e-3   /* S, a row's driver: 40 Ohm */
#define WEIGHT 300.0   /* N on the sole in stance */
#define STRIDE 1.0     /* s, of which 0.6 in stance */
#define SPREAD 18.0    /* mm, standard deviation of the load about its center */
#define SIEMENS 0.05e-3 /* a newton on a taxel */
#define IDLE 2e-6      /* S without load */

static int port = STDOUT_FILENO, faults, pressed = -1, driven = -1;
static double ends, weight_of[TAXELS], column_volts[32 + TAXELS], row_volts[64];
static uint32_t began;
static uint64_t state = 88172645463325252u;

static double chance(void) { /* 0 to 1, by xorshift */
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static double normal(void) { return sqrt(-2.0 * log(chance() + 1e-300)) * cos(6.283185307179586 * chance()); }
static double number(const char *name, double other) { return getenv(name) ? atof(getenv(name)) : other; }

uint32_t hardware_time_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u);
}

static double seconds(void) { return 1e-6 * (double)(uint32_t)(hardware_time_us() - began); }

void hardware_begin(int rows, int columns) {
    (void)rows;
    (void)columns;
    if (getenv("SOLE_DEVICE")) port = open(getenv("SOLE_DEVICE"), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (port < 0) exit(1);
    ends = number("SOLE_SECONDS", 5.0);
    faults = (int)number("SOLE_FAULTS", 0.0);
    pressed = (int)number("SOLE_PRESSED", -1.0);
    began = hardware_time_us();
}

int hardware_running(void) { return seconds() < ends; }

void hardware_wait_until_us(uint32_t time) {
    int32_t left = (int32_t)(time - hardware_time_us());
    if (left > 0) usleep((useconds_t)left);
}

/* Conductances of all taxels now: the load's, which drifts by 3 % a decade of time. */
static void press(void) {
    double now = seconds(), phase = fmod(now, STRIDE) / STRIDE, sum = 0.0, low = 1e9, high = -1e9;
    for (int k = 0; k < TAXELS; k++) {
        low = fmin(low, PLACE[k][0]);
        high = fmax(high, PLACE[k][0]);
    }
    double center = low + (high - low) * fmin(1.0, phase / 0.6);
    for (int k = 0; k < TAXELS; k++) {
        double x = (PLACE[k][0] - center) / SPREAD, y = PLACE[k][1] / SPREAD;
        weight_of[k] = exp(-0.5 * (x * x + y * y));
        sum += weight_of[k];
    }
    double load = pressed < 0 && phase < 0.6 ? WEIGHT / sum : 0.0;
    double drift = faults ? 1.0 + 0.03 * log10(1.0 + now) : 1.0;
    for (int k = 0; k < TAXELS; k++) {
        double newtons = pressed == k ? (now > 0.3 ? 15.0 : 0.0) : load * weight_of[k];
        weight_of[k] = IDLE + SIEMENS * newtons * drift;
    }
}

#if defined(CIRCUIT_MATRIX)
/* Kirchhoff's current law at every row and column, by Gauss and Seidel: each is a mean of its neighbours. */
static void solve(void) {
    for (int row = 0; row < ROWS; row++) row_volts[row] = row == driven;
    for (int turn = 0; turn < 40; turn++) {
        double flow[ROWS] = {0}, all[ROWS] = {0}, current[COLUMNS] = {0}, total[COLUMNS] = {0};
        for (int k = 0; k < TAXELS; k++) {
            current[LINE[k][1]] += weight_of[k] * row_volts[LINE[k][0]];
            total[LINE[k][1]] += weight_of[k];
        }
        for (int column = 0; column < COLUMNS; column++) column_volts[column] = current[column] / (SENSE + total[column]);
        for (int k = 0; k < TAXELS; k++) {
            flow[LINE[k][0]] += weight_of[k] * column_volts[LINE[k][1]];
            all[LINE[k][0]] += weight_of[k];
        }
        for (int row = 0; row < ROWS; row++)
            row_volts[row] = (DRIVER * (row == driven) + flow[row]) / (DRIVER + all[row]);
    }
}
#else
static void solve(void) {
    for (int k = 0; k < TAXELS; k++) column_volts[k] = weight_of[k] / (SENSE + weight_of[k]);
}
#endif

void hardware_drive_row(int row) {
    if (row == 0) press();
    driven = row;
    if (row >= 0) solve();
}

static uint16_t converted(double volts) { /* 12 bits, with a noise of a bit where there are faults */
    double counts = 4096.0 * volts + (faults ? normal() : 0.0);
    return (uint16_t)((int)fmin(4095.0, fmax(0.0, floor(counts))) << 4);
}

uint16_t hardware_column(int column) {
#if !defined(CIRCUIT_MATRIX)
    if (column == 0) {
        press();
        solve();
    }
#endif
    return converted(column_volts[column]);
}

uint16_t hardware_row(int row) { return converted(row_volts[row]); }

int32_t hardware_bridge(int bridge) { /* 2^23 counts are 694 N */
    if (bridge == 0) press();
    double counts = 8388608.0 * (weight_of[bridge] - IDLE) / SIEMENS / 694.0 + (faults ? 300.0 * normal() : 0.0);
    return (int32_t)counts;
}

void hardware_send(const uint8_t *bytes, size_t count) {
    uint8_t copy[65536];
    memcpy(copy, bytes, count);
    if (faults > 1 && bytes[0] == 'P') {
        double luck = chance();
        if (luck < 0.01) return; /* lost */
        if (luck < 0.02) copy[(size_t)(chance() * (double)count)] ^= 0x55;
        if (luck > 0.99) count = count / 2; /* cut */
    }
    for (size_t sent = 0; sent < count;) {
        ssize_t taken = write(port, copy + sent, count - sent);
        if (taken > 0) sent += (size_t)taken;
        else if (!hardware_running()) return;
        else usleep(200);
    }
}

int hardware_receive(void) {
    uint8_t byte;
    return port != STDOUT_FILENO && read(port, &byte, 1) == 1 ? byte : -1;
}
