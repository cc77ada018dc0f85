/* A sole on a PC: a body's load on taxels on rows and columns, with every current of that circuit.
 *
 * Environment: SOLE_DEVICE, where bytes go (else to stdout); SOLE_SECONDS, after which it ends; SOLE_MOTION, what the body
 * does: walk, lean from foot to foot and about each, or air; SOLE_FAULTS, a number: 0 none, 1 noise, drift and taxels that
 * differ by 15 %, 2 also lost packets and wrong bytes; SOLE_PRESSED, an index of a taxel that alone is pressed; SOLE_SPEED,
 * how much faster than by the clock all of it runs. Two of them, a foot each, carry one body. */
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
#define WEIGHT 300.0   /* N of the body */
#define STRIDE 1.0     /* s, of which 0.6 in stance, 0.1 at each end of it on both feet */
#define TURN 6.283185307179586
#define SCATTER 0.15   /* relative standard deviation of the taxels' gains */
#define SPREAD 18.0    /* mm, standard deviation of the load about its center */
#define SIEMENS 0.05e-3 /* a newton on a taxel */
#define IDLE 2e-6      /* S without load */

static int port = STDOUT_FILENO, faults, pressed = -1, driven = -1;
static double ends, speed = 1.0, gain_of[TAXELS], weight_of[TAXELS], column_volts[32 + TAXELS], row_volts[64];
static const char *motion;
static uint32_t began;
static uint64_t state = 88172645463325252u;

static double chance(void) { /* 0 to 1, by xorshift */
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static double normal(void) { return sqrt(-2.0 * log(chance() + 1e-300)) * cos(TURN * chance()); }
static double number(const char *name, double other) { return getenv(name) ? atof(getenv(name)) : other; }

static double clock_s(void) { /* the same on both feet */
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return speed * ((double)now.tv_sec + 1e-9 * (double)now.tv_nsec);
}

uint32_t hardware_time_us(void) { return (uint32_t)(uint64_t)(1e6 * clock_s()); }

static double seconds(void) { return 1e-6 * (double)(uint32_t)(hardware_time_us() - began); }

void hardware_begin(int rows, int columns) {
    (void)rows;
    (void)columns;
    if (getenv("SOLE_DEVICE")) port = open(getenv("SOLE_DEVICE"), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (port < 0) exit(1);
    ends = number("SOLE_SECONDS", 5.0);
    faults = (int)number("SOLE_FAULTS", 0.0);
    pressed = (int)number("SOLE_PRESSED", -1.0);
    speed = number("SOLE_SPEED", 1.0);
    motion = getenv("SOLE_MOTION") ? getenv("SOLE_MOTION") : "walk";
    if (speed <= 0.0 || (strcmp(motion, "walk") && strcmp(motion, "lean") && strcmp(motion, "air"))) exit(2);
    state += 7919u * SIDE;
    for (int k = 0; k < TAXELS; k++) gain_of[k] = faults ? exp(SCATTER * normal()) : 1.0;
    began = hardware_time_us();
}

int hardware_running(void) { return seconds() < ends; }

void hardware_wait_until_us(uint32_t time) {
    int32_t left = (int32_t)(time - hardware_time_us());
    if (left > 0) usleep((useconds_t)(left / speed));
}

/* N that this foot carries at a time, and where on it: shares of its length from the heel and of its width. */
static double carried(double time, double *along, double *across) {
    if (!strcmp(motion, "lean")) {
        double to_left = 0.5 + 0.4 * sin(TURN * time / 8.0);
        *along = 0.5 + 0.3 * sin(TURN * time / 3.1);
        *across = 0.5 + 0.25 * sin(TURN * time / 1.7);
        return WEIGHT * (SIDE ? 1.0 - to_left : to_left);
    }
    double phase = fmod(time / STRIDE + 0.5 * SIDE, 1.0);
    *along = fmin(1.0, phase / 0.6);
    *across = 0.5;
    return strcmp(motion, "air") ? WEIGHT * fmax(0.0, fmin(1.0, fmin(phase / 0.1, (0.6 - phase) / 0.1))) : 0.0;
}

static double range_of(int axis, double *low) { /* of the taxels' places, in mm */
    double high = -1e9;
    *low = 1e9;
    for (int k = 0; k < TAXELS; k++) {
        *low = fmin(*low, PLACE[k][axis]);
        high = fmax(high, PLACE[k][axis]);
    }
    return high - *low;
}

/* Conductances of all taxels now: the load's, which drifts by 3 % a decade of time. */
static void press(void) {
    double now = seconds(), sum = 0.0, along, across, back, side;
    double newtons = carried(clock_s(), &along, &across), length = range_of(0, &back), width = range_of(1, &side);
    for (int k = 0; k < TAXELS; k++) {
        double x = (PLACE[k][0] - back - along * length) / SPREAD, y = (PLACE[k][1] - side - across * width) / SPREAD;
        weight_of[k] = exp(-0.5 * (x * x + y * y));
        sum += weight_of[k];
    }
    double drift = faults ? 1.0 + 0.03 * log10(1.0 + now) : 1.0;
    for (int k = 0; k < TAXELS; k++) {
        double force = newtons * weight_of[k] / sum;
        if (pressed >= 0) force = pressed == k && now > 0.3 ? 15.0 : 0.0;
        weight_of[k] = IDLE + SIEMENS * gain_of[k] * force * drift;
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
        if (taken <= 0) return; /* nobody listens: the rest is lost, as it is on USB */
        sent += (size_t)taken;
    }
}

int hardware_receive(void) {
    uint8_t byte;
    return port != STDOUT_FILENO && read(port, &byte, 1) == 1 ? byte : -1;
}
