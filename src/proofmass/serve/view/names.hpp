#pragma once

#include <cstddef>
#include <string>

// Names of the files in a view's folder.
namespace proofmass::serve {

inline const std::string view_head_name = "head.json", view_stamps_name = "stamps";

inline std::string view_channel_name(std::size_t channel) {
  return "channel" + std::to_string(channel);
}

}  // namespace proofmass::serve
