#pragma once

#include <functional>
#include <string_view>

namespace proofmass {

/// Told how far a long computation has come: its stage in a few words, and the fraction done in
/// [0, 1]. The library never prints; whoever passes one decides what is shown. May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

}  // namespace proofmass
