/* A slow disk for rosbag's recorder: LD_PRELOAD this, and name in SLOW_DISK_FILE a file that holds how many bytes a second
   it takes, as text; empty or 0: as fast as it is. Other programs that inherit it are left alone. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double bytes_per_s(void) {
  const char *name = getenv("SLOW_DISK_FILE");
  FILE *file = name ? fopen(name, "r") : NULL;
  double rate = 0.0;
  if (file) {
    if (fscanf(file, "%lf", &rate) != 1) rate = 0.0;
    fclose(file);
  }
  return rate;
}

size_t fwrite(const void *data, size_t size, size_t count, FILE *file) {
  static size_t (*real)(const void *, size_t, size_t, FILE *);
  if (!real) real = (size_t(*)(const void *, size_t, size_t, FILE *))dlsym(RTLD_NEXT, "fwrite");
  if (strcmp(program_invocation_short_name, "record") == 0) {
    const double rate = bytes_per_s();
    if (rate > 0.0) {
      const double wait_s = (double)(size * count) / rate;
      struct timespec wait = {(time_t)wait_s, (long)(1e9 * (wait_s - (double)(time_t)wait_s))};
      nanosleep(&wait, NULL);
    }
  }
  return real(data, size, count, file);
}
