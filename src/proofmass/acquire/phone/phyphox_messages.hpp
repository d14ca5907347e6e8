#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

// Messages of the app phyphox's remote interface. Source: phyphox.org, wiki, "Remote-interface
// communication".
namespace proofmass::acquire {

/// Response to "/config": the experiment open on the phone.
struct PhyphoxConfig {
  struct Buffer {
    std::string name;
    std::uint64_t rows = 0;  ///< capacity; 0: unlimited
  };
  struct Input {
    std::string source{};                          ///< "accelerometer"
    std::map<std::string, std::string> outputs{};  ///< "x", "y", "z", "t", … to buffer names
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

/// Errors: corrupt (not JSON, no buffers).
[[nodiscard]] Result<PhyphoxConfig> parse_phyphox_config(std::string_view text);

/// Response to "/get": the requested buffers, and whether the measurement is running.
struct PhyphoxReply {
  std::string session{};  ///< changes if another experiment is opened
  bool measuring = false;
  std::vector<std::vector<double>> buffers{};  ///< in the order of the request; NaN for null
  std::vector<bool> is_there{};                ///< whether the phone has the buffer
};

/// `out` keeps its capacity. Errors: corrupt (not JSON, no status).
[[nodiscard]] Status parse_phyphox_reply(std::string_view text,
                                         const std::vector<std::string>& names,
                                         PhyphoxReply& out);

/// Truncates buffers that fill together to whole rows: the phone appends to one after the other, so
/// the rows are complete up to the shortest. Rows without a time, the first buffer, cannot be used:
/// they are removed, and their number is returned.
std::size_t level_buffers(std::span<std::vector<double>> buffers);

/// Response to "/control": whether the phone executed the command. Errors: corrupt.
[[nodiscard]] Result<bool> parse_phyphox_result(std::string_view text);

/// Response to "/time": the phone's time of day, in seconds since 1970, at zero of the experiment's
/// time, at the last start; nullopt if there was none. Errors: corrupt.
[[nodiscard]] Result<std::optional<double>> parse_phyphox_time(std::string_view text);

}  // namespace proofmass::acquire
