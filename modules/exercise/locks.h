// What a person who practises must not change. An exercise may lock it, and so may the workstation
// (policy.h).
#pragma once

#include <set>

#include "exercise/names.h"

namespace trephine {

enum class Lock { controller, tissues, rate };
using Locks = std::set<Lock>;

inline constexpr Names<Lock, 3> kLockNames{
    {{"controller", Lock::controller}, {"tissues", Lock::tissues}, {"rate", Lock::rate}}};

}  // namespace trephine
