#include "record/live_source.hpp"

#include <cstdlib>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "input/input.hpp"

namespace proofmass::app {
namespace {

// A source whose unknown units are given by the user.
class NamedUnits final : public acquire::Source {
 public:
  NamedUnits(std::unique_ptr<acquire::Source> source, const Unit& unit)
      : source_(std::move(source)), head_(source_->head()) {
    for (Channel& channel : head_.recording.channels)
      if (channel.unit.quantity == Quantity::unknown) channel.unit = unit;
  }
  [[nodiscard]] const acquire::SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<acquire::Arrived> read(acquire::Arrival& arrival,
                                              std::chrono::milliseconds patience) override {
    return source_->read(arrival, patience);
  }

 private:
  std::unique_ptr<acquire::Source> source_;
  acquire::SourceHead head_;
};

std::string with_setting(const std::string& uri, const std::string& setting) {
  return uri + (uri.find('?') == std::string::npos ? "?" : "&") + setting;
}

std::string uri_of(const RecordCommand& command) {
  const std::string uri = command.source == "-" ? "stdin:" : command.source;
  return command.input.rate_hz ? with_setting(uri, fmt::format("rate={}", *command.input.rate_hz))
                               : uri;
}

}  // namespace

acquire::OpenOptions open_options() {
  const char* nidaqmx = std::getenv("PROOFMASS_NIDAQMX_LIB");
  acquire::OpenOptions options;
  options.stopped = interruption_waits;
  options.duckdb_library = duckdb_library();
  options.nidaqmx_library = nidaqmx == nullptr ? "" : nidaqmx;
  return options;
}

acquire::OpenSource source_opener(const RecordCommand& command) {
  return [uri = uri_of(command), unit = command.input.unit,
          options = open_options()]() -> Result<std::unique_ptr<acquire::Source>> {
    auto source = acquire::open_source(uri, options);
    if (!source || unit.empty()) return source;
    return std::unique_ptr<acquire::Source>(
        std::make_unique<NamedUnits>(std::move(source).value(), *parse_unit(unit)));
  };
}

}  // namespace proofmass::app
