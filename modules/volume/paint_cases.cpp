// Paints a built-in case and writes its file: a step of the build.
//   paint_cases NAME FILE
#include <cstdio>

#include "base/file.h"
#include "volume/phantom_file.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: paint_cases NAME FILE\n");
    return 1;
  }
  const std::filesystem::path file = argv[2];
  trephine::Status written = trephine::makeFolder(file.parent_path());
  if (written) written = trephine::writePhantomFile(argv[1], file);
  if (written) return 0;
  std::fprintf(stderr, "paint_cases: %s\n", written.error().sentence().c_str());
  return 1;
}
