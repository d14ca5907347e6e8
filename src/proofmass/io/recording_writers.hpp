#pragma once

#include <functional>
#include <string_view>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// Takes the next bytes of a file; false if they could not be written.
using Sink = std::function<bool(std::string_view)>;

/// Write a recording as write_recording says; false if the sink refused.
[[nodiscard]] bool write_csv(const Recording& recording, const Sink& sink);
[[nodiscard]] bool write_npy(const Recording& recording, const Sink& sink);

}  // namespace proofmass::io
