#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

// What the app phyphox says to who asks it over the network.
// Source: phyphox.org, wiki, "Remote-interface communication".
namespace proofmass::acquire {

/// Of "/config": the experiment that is open on the phone.
struct PhyphoxConfig {
  struct Buffer {
    std::string name;
    std::uint64_t rows = 0;  ///< that it holds at most; 0: all
  };
  struct Input {
    std::string source{};                          ///< "accelerometer"
    std::map<std::string, std::string> outputs{};  ///< "x", "y", "z", "t", … to buffers
  };
  struct Export {
    std::string label;  ///< "Acceleration x (m/s^2)"
    std::string buffer;
    std::size_t set = 0;
  };
  std::string title{};
  std::vector<Buffer> buffers{};
  std::vector<Input> inputs{};
  std::vector<Export> exports{};
};

/// Errors: corrupt (no JSON, no buffers).
[[nodiscard]] Result<PhyphoxConfig> parse_phyphox_config(std::string_view text);

/// Of "/get": what was asked of the buffers, and whether it goes on.
struct PhyphoxReply {
  std::string session{};  ///< another one where another experiment was opened
  bool measuring = false;
  std::vector<std::vector<double>> buffers{};  ///< in the order asked for; NaN for null
  std::vector<bool> is_there{};                ///< whether the phone knows the buffer
};

/// `out` keeps its memory. Errors: corrupt (no JSON, no status).
[[nodiscard]] Status parse_phyphox_reply(std::string_view text,
                                         const std::vector<std::string>& names,
                                         PhyphoxReply& out);

/// Cuts buffers that fill together to whole rows: the phone appends to one after the other, so they
/// are whole as far as the shortest goes. Rows without a time, which is the first, can be put
/// nowhere: they are taken out, and how many they are comes back.
std::size_t level_buffers(std::span<std::vector<double>> buffers);

/// Of "/control": whether the phone did what it was told. Errors: corrupt.
[[nodiscard]] Result<bool> parse_phyphox_result(std::string_view text);

/// Of "/time": the phone's time of day, in seconds since 1970, at zero of the experiment's time, by
/// the last start; nullopt where there was none. Errors: corrupt.
[[nodiscard]] Result<std::optional<double>> parse_phyphox_time(std::string_view text);

}  // namespace proofmass::acquire
