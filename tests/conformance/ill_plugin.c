/* A driver that ends its program, never returns, or talks: ILL_PLUGIN says which. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

__attribute__((visibility("default"))) const void* trephine_device_plugin(uint32_t abi) {
  const char* how = getenv("ILL_PLUGIN");
  (void)abi;
  if (how && strcmp(how, "ends") == 0) abort();
  if (how && strcmp(how, "talks") == 0) puts("A driver, version 1.0");
  while (how && strcmp(how, "blocks") == 0) pause();
  return NULL;
}
