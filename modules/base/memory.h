// Memory of this process, and how much more it may take. In MB of 2^20 bytes. Any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"

namespace trephine {

// Resident memory now and at its peak.
double residentMb();
double peakResidentMb();

// What could be allocated now without pushing anything out to disk, and without the kernel ending
// the process for it: the least of what the machine, the process's control groups (memory.max) and
// RLIMIT_DATA leave.
double availableMemoryMb();

// The least that the control groups of a process leave, itself and all that it lies in; nothing
// where none has a limit. Pages of files do not count: the kernel drops those. `membership` is as
// /proc/self/cgroup, `mounted` as /sys/fs/cgroup, of either version.
std::optional<double> controlGroupMemoryMb(const std::filesystem::path& membership,
                                           const std::filesystem::path& mounted);

// Of that, what one program may take: some is left to everything else.
double usableMemoryMb();

// Whether that much can be taken. To be asked before it is: beyond a control group's limit no
// allocation fails, the process is killed. `what` needs it ("Reading the series"), `where` as in an
// Error. Error: OUT_OF_MEMORY, with both figures.
Status enoughMemory(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb = usableMemoryMb());
// Of what is read whole before it can be cropped.
Status enoughToRead(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb = usableMemoryMb());

// The same of an allocation that failed: "There is not enough memory " + `what` ("for the case").
Error outOfMemory(const std::string& what, const std::string& where);

}  // namespace trephine
