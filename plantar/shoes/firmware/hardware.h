/* What a board does for sole.c. One file of these functions a board: hardware_pico.c, hardware_simulated.c. */
#ifndef HARDWARE_H
#define HARDWARE_H

#include <stddef.h>
#include <stdint.h>

void hardware_begin(int rows, int columns);
int hardware_running(void);           /* 0 ends the program, where one can end */
uint32_t hardware_time_us(void);      /* wraps after 71 minutes */
void hardware_wait_until_us(uint32_t time);
void hardware_drive_row(int row);     /* this row to the supply, all others to ground; -1: all to ground */
uint16_t hardware_column(int column); /* voltage of a column, or of an FSR's divider: 0 to 65535, the supply */
uint16_t hardware_row(int row);       /* voltage of a row, the same */
int32_t hardware_bridge(int bridge);  /* a bridge amplifier's 24 bits, signed */
void hardware_send(const uint8_t *bytes, size_t count);
int hardware_receive(void);           /* a byte, or -1 */

#endif
