/* Writes a turning wheel's acceleration into the registers of accelerometers on an i2c-stub bus.
 *
 *     accelgen BUS set ADDRESS REGISTER VALUE
 *     accelgen BUS run RATE_HZ TURNS_PER_S {ADDRESS REGISTER COUNTS_PER_G}...
 *
 * Axes are three 16-bit figures, the low byte first, of which the chips use the upper 12 bits.
 */
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>

static int transfer(int bus, int address, int reg, int size, union i2c_smbus_data* data) {
  struct i2c_smbus_ioctl_data request = {I2C_SMBUS_WRITE, (uint8_t)reg, (uint32_t)size, data};
  if (ioctl(bus, I2C_SLAVE_FORCE, address) == 0 && ioctl(bus, I2C_SMBUS, &request) == 0) return 0;
  perror("accelgen");
  return 1;
}

static int set(int bus, int address, int reg, int value) {
  union i2c_smbus_data data = {.byte = (uint8_t)value};
  return transfer(bus, address, reg, I2C_SMBUS_BYTE_DATA, &data);
}

static int write_axes(int bus, int address, int reg, double counts_per_g, double phase) {
  const double g[3] = {cos(phase), sin(phase), 0.03 * sin(7.0 * phase)};
  union i2c_smbus_data data;
  data.block[0] = 6;
  for (int axis = 0; axis < 3; ++axis) {
    const uint16_t word = (uint16_t)((int)lround(counts_per_g * g[axis]) * 16);
    data.block[1 + 2 * axis] = word & 255;
    data.block[2 + 2 * axis] = (uint8_t)(word >> 8);
  }
  return transfer(bus, address, reg, I2C_SMBUS_I2C_BLOCK_DATA, &data);
}

static double now_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int run(int bus, double rate_hz, double turns_per_s, int count, char** chips) {
  const double start_s = now_s();
  for (long step = 1;; ++step) {
    const double phase = 2.0 * M_PI * turns_per_s * (now_s() - start_s);
    for (int k = 0; k + 2 < count; k += 3)
      if (write_axes(bus, (int)strtol(chips[k], 0, 0), (int)strtol(chips[k + 1], 0, 0), atof(chips[k + 2]), phase))
        return 1;
    const double next_s = start_s + (double)step / rate_hz;
    const struct timespec next = {(time_t)next_s, (long)((next_s - floor(next_s)) * 1e9)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, 0);
  }
}

int main(int count, char** words) {
  const int bus = count > 5 ? open(words[1], O_RDWR) : -1;
  if (bus >= 0 && strcmp(words[2], "set") == 0)
    return set(bus, (int)strtol(words[3], 0, 0), (int)strtol(words[4], 0, 0), (int)strtol(words[5], 0, 0));
  if (bus >= 0 && count > 7 && strcmp(words[2], "run") == 0)
    return run(bus, atof(words[3]), atof(words[4]), count - 5, words + 5);
  fprintf(stderr, "accelgen: no such bus, or too few words; see the head of accelgen.c\n");
  return 2;
}
