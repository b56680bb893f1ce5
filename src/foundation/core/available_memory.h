#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Memory that new allocations may take without swapping (MemAvailable of /proc/meminfo). Returns the largest
/// std::uint64_t if the system does not state it.
std::uint64_t available_memory_bytes();

/// Resident memory of this process (VmRSS of /proc/self/status); 0 if the system does not state it.
std::uint64_t resident_memory_bytes();
/// Returns freed memory to the system. The allocator keeps large blocks per thread: call this after releasing tens of
/// megabytes. Takes some milliseconds; not real-time safe.
void release_freed_memory();

/// An error at `where` if an image of `bytes` and a converted copy of it do not fit into `available_bytes`. Call it
/// before the allocation: Linux overcommits memory and kills a program that uses more than exists.
Status check_memory_for_image(std::uint64_t bytes, std::uint64_t available_bytes, const std::string& where);

}  // namespace core
}  // namespace trocar
