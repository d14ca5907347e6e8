#pragma once

#include <comedilib.h>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

struct CloseComedi {
  void operator()(comedi_t* device) const { comedi_close(device); }
};
using ComediDevice = std::unique_ptr<comedi_t, CloseComedi>;

struct ComediRequest {
  std::string path{};
  std::vector<unsigned> channels{};  ///< empty: all of the card's
  double rate_hz = 1000.0;
  unsigned range = 0;  ///< by the card's own numbering
  unsigned reference = AREF_GROUND;
};

/// Evenly timed acquisition of a card's inputs, configured but not started.
struct ComediCommand {
  ComediDevice device;
  unsigned subdevice = 0;
  std::vector<unsigned> list;  ///< channel, range and reference, packed
  comedi_cmd command{};        ///< its list is `list`
  std::size_t sample_bytes = 2;
  std::vector<comedi_polynomial_t> to_physical;  ///< one per channel
  std::vector<Channel> heads;
  double rate_hz = 0.0;  ///< granted
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// Text of the library's last error: "Device or resource busy".
[[nodiscard]] std::string comedi_reason();

/// Errors: device (absent, no analogue input, no timed acquisition), invalid_argument (a channel,
/// range or reference that the card does not have, with the available ones).
[[nodiscard]] Result<ComediCommand> prepare_command(const ComediRequest& request);

/// Errors: device (busy: in use by another program).
[[nodiscard]] Status start(ComediCommand& command);

}  // namespace proofmass::acquire
