#pragma once

namespace trocar::detail {

/// Stops the image libraries from writing to the terminal: what is wrong with a file is said once, by our error.
/// Cheap after the first call; safe from any thread.
void silence_libraries();

}  // namespace trocar::detail
