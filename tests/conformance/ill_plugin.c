/* A driver that ends its program, or never returns: ILL_PLUGIN says which. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

__attribute__((visibility("default"))) const void* trephine_device_plugin(uint32_t abi) {
  const char* how = getenv("ILL_PLUGIN");
  (void)abi;
  if (how && strcmp(how, "ends") == 0) abort();
  while (how && strcmp(how, "blocks") == 0) pause();
  return NULL;
}
