#include "training/own_dataset.h"

#include <cstddef>

namespace trephine {

namespace {

constexpr std::size_t kMostChunkBytes = std::size_t{16} << 20;

bool isOwnLayout(hid_t dataset, hid_t properties) {
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (layout == H5D_CONTIGUOUS) return H5Pget_external_count(properties) == 0;
  hsize_t rows = 0;
  if (layout != H5D_CHUNKED || H5Pget_chunk(properties, 1, &rows) != 1) return false;
  const hid_t type = H5Dget_type(dataset);
  const std::size_t row_bytes = H5Tget_size(type);
  H5Tclose(type);
  return row_bytes > 0 && rows <= kMostChunkBytes / row_bytes;
}

// Each deflate takes up to 1032 bytes for one: more than one of them is a bomb.
bool hasOwnFilters(hid_t properties) {
  const int count = H5Pget_nfilters(properties);
  int deflates = 0;
  for (int n = 0; n < count; ++n) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, unsigned(n), &flags, &values, nullptr, 0, nullptr, &config);
    if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE) return false;
    deflates += filter == H5Z_FILTER_DEFLATE ? 1 : 0;
  }
  return count >= 0 && deflates <= 1;
}

// Before its space is asked for: that of a virtual dataset opens its sources.
bool isStoredAsOurs(hid_t dataset) {
  const hid_t properties = H5Dget_create_plist(dataset);
  if (properties < 0) return false;
  const bool ours = isOwnLayout(dataset, properties) && hasOwnFilters(properties) &&
                    storedBytes(dataset) != kLies;
  H5Pclose(properties);
  return ours;
}

bool isHardLink(hid_t file, const char* name) {
  H5L_info_t link;
  return H5Lget_info(file, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
}

}  // namespace

hsize_t storedBytes(hid_t dataset) {
  const hsize_t stored = H5Dget_storage_size(dataset);  // first: a file that is written grows
  const hid_t file = H5Iget_file_id(dataset);
  hsize_t whole = 0;
  const bool known = file >= 0 && H5Fget_filesize(file, &whole) >= 0;
  if (file >= 0) H5Fclose(file);
  return known && stored <= whole ? stored : kLies;
}

hid_t openOwnDataset(hid_t file, const char* name) {
  if (!isHardLink(file, name)) return -1;
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (dataset < 0 || isStoredAsOurs(dataset)) return dataset;
  H5Dclose(dataset);
  return -1;
}

bool isForeign(hid_t file, const char* name) {
  if (H5Lexists(file, name, H5P_DEFAULT) <= 0) return false;
  if (!isHardLink(file, name)) return true;
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (dataset < 0) return false;
  const bool foreign = !isStoredAsOurs(dataset);
  H5Dclose(dataset);
  return foreign;
}

bool isOneElement(hid_t space) {
  return H5Sget_simple_extent_npoints(space) == 1;
}

}  // namespace trephine
