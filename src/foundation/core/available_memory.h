#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Memory that new allocations may take without swapping (MemAvailable of /proc/meminfo). Where the system does not
/// state it: the largest number.
std::uint64_t available_memory_bytes();

/// Memory of this process that is in the machine's memory now (VmRSS of /proc/self/status); 0 where the system does not
/// state it.
std::uint64_t resident_memory_bytes();
/// Returns freed memory to the system. The allocator keeps large blocks per thread: call this after releasing tens of
/// megabytes. Takes some milliseconds; not real-time safe.
void release_freed_memory();

/// An error at `where` if an image of `bytes` and a converted copy of it do not fit into `available_bytes`. Asked for
/// before the allocation: Linux grants more memory than there is and ends a program when it is used.
Status check_memory_for_image(std::uint64_t bytes, std::uint64_t available_bytes, const std::string& where);

}  // namespace core
}  // namespace trocar
