/* Reads the taxels of a sole and sends them as packets: C99 without libraries, for any board with a hardware_*.c.
 *
 * Packet, little endian: 'P' 'L', version 1, side (0 left, 1 right), sequence (16 bits), time in us (32), number of
 * taxels (16), a value each (16) in the order of the layout, CRC-16/CCITT-FALSE of all before it (16).
 * A value is the taxel's conductance over that of the resistor to ground, times VALUE_ONE; of a bridge its upper 16 bits
 * and 32768. Bytes that are received: 'n' names the taxel that is pressed, as text; 'r' goes back to packets. */
#include "sole.h" /* written for each sole: SIDE, TAXELS, ROWS, COLUMNS, PERIOD_US, LINE, ID and one CIRCUIT_ */
#include "hardware.h"

#define VALUE_ONE 8192.0f
#define HEAD 12
#define NAMED 300 /* by which a value exceeds that at rest where its taxel is named: 4 % of the resistor's conductance */

static uint16_t value[TAXELS];

static uint16_t crc16(const uint8_t *bytes, size_t count) {
    uint16_t crc = 0xFFFF;
    for (size_t i = 0; i < count; i++) {
        crc ^= (uint16_t)(bytes[i] << 8);
        for (int bit = 0; bit < 8; bit++) crc = (uint16_t)(crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1);
    }
    return crc;
}

#if !defined(CIRCUIT_BRIDGE)
static uint16_t coded(float conductance) {
    float code = conductance * VALUE_ONE + 0.5f;
    return code < 0.0f ? 0 : code > 65535.0f ? 65535 : (uint16_t)code;
}
#endif

#if defined(CIRCUIT_MATRIX)
/* One row after another is at the supply, all others at ground, and all voltages are read, since drivers and resistors let
 * every line rise. Of a column at v then sum of G_i (u_i - v) = Gs v over its rows at u_i, for each row that is driven:
 * as many equations as taxels, which are solved by elimination. No current of other taxels is left in the result. */
static float level[ROWS][ROWS], volts[ROWS][COLUMNS], found[ROWS][COLUMNS];

static void solve(int column) {
    float m[ROWS][ROWS + 1];
    for (int r = 0; r < ROWS; r++) {
        for (int i = 0; i < ROWS; i++) m[r][i] = level[r][i] - volts[r][column];
        m[r][ROWS] = volts[r][column];
    }
    for (int k = 0; k < ROWS; k++) {
        int best = k;
        for (int r = k + 1; r < ROWS; r++)
            if (m[r][k] * m[r][k] > m[best][k] * m[best][k]) best = r;
        for (int i = k; i <= ROWS; i++) {
            float swapped = m[k][i];
            m[k][i] = m[best][i];
            m[best][i] = swapped;
        }
        for (int r = 0; r < ROWS; r++) {
            if (r == k || m[k][k] == 0.0f) continue;
            float share = m[r][k] / m[k][k];
            for (int i = k; i <= ROWS; i++) m[r][i] -= share * m[k][i];
        }
    }
    for (int r = 0; r < ROWS; r++) found[r][column] = m[r][r] == 0.0f ? 8.0f : m[r][ROWS] / m[r][r];
}

static void scan(void) {
    for (int row = 0; row < ROWS; row++) {
        hardware_drive_row(row);
        for (int i = 0; i < ROWS; i++) level[row][i] = (float)hardware_row(i);
        for (int column = 0; column < COLUMNS; column++) volts[row][column] = (float)hardware_column(column);
    }
    hardware_drive_row(-1);
    for (int column = 0; column < COLUMNS; column++) solve(column);
    for (int k = 0; k < TAXELS; k++) value[k] = coded(found[LINE[k][0]][LINE[k][1]]);
}
#elif defined(CIRCUIT_DIVIDER)
static void scan(void) {
    for (int k = 0; k < TAXELS; k++) {
        float v = (float)hardware_column(k) / 65536.0f;
        value[k] = coded(v / (1.0f - v));
    }
}
#else
static void scan(void) {
    for (int k = 0; k < TAXELS; k++) value[k] = (uint16_t)((hardware_bridge(k) >> 8) + 32768);
}
#endif

static uint8_t *put(uint8_t *at, uint32_t number, int bytes) {
    for (int i = 0; i < bytes; i++) *at++ = (uint8_t)(number >> (8 * i));
    return at;
}

static void send_packet(uint16_t sequence, uint32_t time) {
    static uint8_t packet[HEAD + 2 * TAXELS + 2];
    uint8_t *at = packet;
    *at++ = 'P';
    *at++ = 'L';
    *at++ = 1;
    *at++ = SIDE;
    at = put(at, sequence, 2);
    at = put(at, time, 4);
    at = put(at, TAXELS, 2);
    for (int k = 0; k < TAXELS; k++) at = put(at, value[k], 2);
    at = put(at, crc16(packet, (size_t)(at - packet)), 2);
    hardware_send(packet, (size_t)(at - packet));
}

static char *write_number(char *at, unsigned number) {
    char digits[10];
    int count = 0;
    do digits[count++] = (char)('0' + number % 10); while ((number /= 10) != 0);
    while (count) *at++ = digits[--count];
    return at;
}

/* Sends "T17 1250\n", the taxel whose value exceeds that at rest by the most, and by how much; "-\n" where none does. */
static void send_name(const uint16_t *rest) {
    static int last = -2;
    int most = NAMED, found = -1;
    for (int k = 0; k < TAXELS; k++) {
        int over = (int)value[k] - (int)rest[k];
        if (over > most) {
            most = over;
            found = k;
        }
    }
    if (found == last) return;
    last = found;
    char text[24], *at = text;
    *at++ = found < 0 ? '-' : 'T';
    if (found >= 0) {
        at = write_number(at, ID[found]);
        *at++ = ' ';
        at = write_number(at, (unsigned)most);
    }
    *at++ = '\n';
    hardware_send((const uint8_t *)text, (size_t)(at - text));
}

int main(void) {
    static uint16_t rest[TAXELS];
    uint16_t sequence = 0;
    int naming = 0;
    hardware_begin(ROWS, COLUMNS);
    uint32_t next = hardware_time_us();
    while (hardware_running()) {
        hardware_wait_until_us(next);
        uint32_t time = hardware_time_us();
        scan();
        int asked = hardware_receive();
        if (asked == 'r') naming = 0;
        if (asked == 'n') {
            naming = 1;
            for (int k = 0; k < TAXELS; k++) rest[k] = value[k];
        }
        if (naming) send_name(rest);
        else send_packet(sequence++, time);
        next += PERIOD_US;
        if ((int32_t)(hardware_time_us() - next) > 0) next = hardware_time_us(); /* a scan took longer than its period */
    }
    return 0;
}
