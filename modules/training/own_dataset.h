// Datasets of an HDF5 file that may come from anybody: opened only where they are stored as
// session_recorder stores them, so that the file opens no other and runs no code.
#pragma once

#include <hdf5.h>

namespace trephine {

// A dataset in the file's root group. It has to be a hard link to data in the same file, stored in
// one piece or in chunks, unfiltered or by shuffle and one deflate: no soft or external link, no
// external raw storage, no virtual dataset, no filter that HDF5 would load from a plugin. One chunk
// says that it takes at most 16 MB of memory. Returns an identifier that the caller closes with
// H5Dclose, below 0 where there is none of that name or it is stored in another way.
hid_t openOwnDataset(hid_t file, const char* name);

// Whether there is something of this name that may not be opened, other than by damage.
bool isForeign(hid_t file, const char* name);

// Bytes that a dataset takes of its file; kLies where it says more than the file has.
constexpr hsize_t kLies = ~hsize_t{0};
hsize_t storedBytes(hid_t dataset);

// Whether a space is of exactly one element, so that reading all of it writes one.
bool isOneElement(hid_t space);

}  // namespace trephine
