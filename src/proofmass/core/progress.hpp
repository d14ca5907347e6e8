#pragma once

#include <functional>
#include <string_view>

namespace proofmass {

/// Callback for the progress of a long computation: its stage in a few words, and the fraction done
/// in [0, 1]. The library never prints; the caller decides what is shown. May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

}  // namespace proofmass
