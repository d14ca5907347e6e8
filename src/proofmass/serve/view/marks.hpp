#pragma once

#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/serve/view/file.hpp"

namespace proofmass::serve {

/// Finds rests of the first accelerometer, or of the first three channels where there is none, and
/// the outliers within them, and adds them to the head. `folder` has the channels' files. Without
/// rests the head says why. Errors: unreadable.
[[nodiscard]] Status find_marks(const std::string& folder, ViewHead& head);

}  // namespace proofmass::serve
