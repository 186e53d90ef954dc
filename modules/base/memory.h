// Memory of this process, and how much more it may take. In MB of 2^20 bytes. Any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"

namespace trephine {

// Resident memory now and at its peak; 0 where /proc cannot be read.
double residentMb();
double peakResidentMb();

// Gives the pages of freed memory back to the system, which the C library otherwise keeps between
// blocks that are still in use. To be asked after something large has ended, an exercise or an
// import; takes some ms.
void giveBackFreedMemory();

// What could be allocated now without pushing anything out to disk, and without the kernel ending
// the process for it: the least of what the machine, the process's control groups (memory.max) and
// RLIMIT_DATA leave.
double availableMemoryMb();

// The least that the control groups of a process leave, itself and all that it lies in; nothing
// where none has a limit. Pages of files do not count: the kernel drops those. `membership` is as
// /proc/self/cgroup, `mounted` as /sys/fs/cgroup, of either version.
std::optional<double> controlGroupMemoryMb(const std::filesystem::path& membership,
                                           const std::filesystem::path& mounted);

// availableMemoryMb() less 64 MB, which are left to everything else.
double usableMemoryMb();

// Whether that much can be taken. To be asked before it is: beyond a control group's limit no
// allocation fails, the process is killed. `what` needs it: the sentence's subject, translated by
// the caller (tr("Reading the series")). `where` is an Error's: a file, field or part. Nothing is
// reserved: two threads may both be told yes. Error: OUT_OF_MEMORY, with both figures.
Status enoughMemory(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb = usableMemoryMb());
// The same with other advice: of what is read whole before it can be cropped, so that cropping does
// not help.
Status enoughToRead(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb = usableMemoryMb());

// OUT_OF_MEMORY of an allocation that failed: "There is not enough memory " + `what`, translated by
// the caller and unlike enoughMemory()'s not a subject: tr("for the case"), tr("to save the case").
Error outOfMemory(const std::string& what, const std::string& where);

}  // namespace trephine
