#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/acquire/framing/words.hpp"
#include "proofmass/acquire/network/web_socket.hpp"
#include "proofmass/acquire/phone/advice.hpp"
#include "proofmass/acquire/phone/phone_stream_merge.hpp"
#include "proofmass/acquire/phone/sensor_server_messages.hpp"
#include "proofmass/acquire/phone/sensors.hpp"
#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/host_text.hpp"

namespace proofmass::acquire {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr unsigned short sensor_server_port = 8080;
constexpr std::string_view android = "android.sensor.";
/// Limit per read: a tenth of a second at any phone's rate.
constexpr std::size_t most_messages = 500;

/// A requested sensor, and what is known from its first message.
struct Listed {
  std::string type;
  std::size_t width = 0;  ///< 0: no message yet
};

std::string target_of(const std::vector<Listed>& sensors) {
  if (sensors.size() == 1) return "/sensor/connect?type=" + query_text(sensors.front().type);
  std::vector<std::string> quoted;
  for (const Listed& sensor : sensors) quoted.push_back(fmt::format("\"{}\"", sensor.type));
  return "/sensors/connect?types=" + query_text(fmt::format("[{}]", fmt::join(quoted, ",")));
}

void add_channels(Recording& recording, const Listed& sensor) {
  const std::string_view kind = std::string_view(sensor.type).starts_with(android)
                                    ? std::string_view(sensor.type).substr(android.size())
                                    : std::string_view(sensor.type);
  const PhoneSensor known = phone_sensor(kind);
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  for (std::size_t k = 0; k < sensor.width; ++k) {
    std::string name = known.short_name;
    if (known.has_axes && k < axes.size())
      name += fmt::format("_{}", axes[k]);
    else if (sensor.width > 1)
      name += fmt::format("_{}", k);
    recording.channels.push_back({.name = std::move(name), .unit = known.unit, .values = {}});
  }
}

/// Receives from the app SensorServer.
class SensorServerSource : public Source {
 public:
  SensorServerSource(HostPort server, std::vector<Listed> sensors)
      : sensors_(std::move(sensors)),
        accuracy_(sensors_.size(), -1),
        socket_(std::move(server), target_of(sensors_)) {
    head_.has_device_clock = true;
  }

  /// Waits until each sensor has sent a message, which determines its number of values.
  Status open(const std::string& uri, const OpenOptions& options) {
    const auto until = Clock::now() + options.patience;
    while (!std::ranges::all_of(sensors_, &Listed::width, {})) {
      if (options.stopped && options.stopped())
        return Error{Errc::device, "was stopped while it was opened"};
      if (Clock::now() >= until) return silent(options.patience);
      const auto message = socket_.read(milliseconds(50));
      if (!message) return sensor_server_gone(message.error());
      if (*message) learn(**message);
    }
    describe(uri);
    for (const std::string& text : std::exchange(early_, {})) take(text);
    return Done{};
  }

  [[nodiscard]] const SourceHead& head() const override { return head_; }

  [[nodiscard]] Result<Arrived> read(Arrival& arrival, milliseconds patience) override {
    arrival.clear(head_.recording.channels.size());
    const auto until = Clock::now() + patience;
    for (std::size_t count = 0; count < most_messages; ++count) {
      const bool has_rows = arrival.rows() > 0;
      const auto left = std::chrono::ceil<milliseconds>(until - Clock::now());
      const auto message =
          socket_.read(has_rows ? milliseconds(0) : std::max(left, milliseconds(0)));
      if (!message && has_rows) break;  // reported again at the next read
      if (!message) return sensor_server_gone(message.error());
      if (!*message) break;
      take(**message);
      merge_->take(arrival);
    }
    for (Note& note : merge_->take_notes()) notes_.push_back(std::move(note));
    arrival.host_ns = host_now_ns();
    arrival.notes.swap(notes_);
    return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
  }

 private:
  /// The sensor of a message, which has no type if only one was requested.
  [[nodiscard]] std::optional<std::size_t> sensor_of(std::string_view text) {
    if (const Status read = parse_sensor_message(text, message_); !read)
      return pass_over(read.error().message);
    if (sensors_.size() == 1) return 0;
    const auto found = std::ranges::find(sensors_, message_.type, &Listed::type);
    if (found == sensors_.end())
      return pass_over(fmt::format("is of the sensor \"{}\"", message_.type));
    return static_cast<std::size_t>(found - sensors_.begin());
  }
  std::nullopt_t pass_over(const std::string& why) {
    ++skipped_;
    if (skipped_ == noted_at_) {
      noted_at_ *= 10;
      notes_.push_back({Severity::warning,
                        fmt::format("SensorServer: message {} is skipped: it {}", skipped_, why)});
    }
    return std::nullopt;
  }
  void learn(std::string_view text) {
    const auto sensor = sensor_of(text);
    if (!sensor) return;
    if (sensors_[*sensor].width == 0) sensors_[*sensor].width = message_.values.size();
    early_.emplace_back(text);
  }
  void take(std::string_view text) {
    const auto sensor = sensor_of(text);
    if (!sensor) return;
    if (message_.values.size() != sensors_[*sensor].width) {
      static_cast<void>(pass_over(fmt::format("has {} values, and had {}", message_.values.size(),
                                              sensors_[*sensor].width)));
      return;
    }
    merge_->add(*sensor, message_.timestamp_ns, message_.values);
    const int before = std::exchange(accuracy_[*sensor], message_.accuracy);
    if (message_.accuracy == 0 && before != 0)
      notes_.push_back(
          {Severity::warning,
           fmt::format("{}: the phone calls it unreliable from here on", sensors_[*sensor].type)});
  }
  void describe(const std::string& uri) {
    std::vector<std::size_t> widths;
    head_.recording.source = uri;
    head_.recording.format = "SensorServer";
    for (const Listed& sensor : sensors_) {
      widths.push_back(sensor.width);
      add_channels(head_.recording, sensor);
      head_.settings.emplace_back("sensor", sensor.type);
    }
    if (sensors_.size() > 1)
      head_.settings.emplace_back(
          "rows",
          fmt::format("those of {}; the others' values on the line between their neighbours",
                      sensors_.front().type));
    merge_.emplace(widths);
  }
  [[nodiscard]] Error silent(milliseconds patience) const {
    const auto first = std::ranges::find(sensors_, std::size_t{0}, &Listed::width);
    return sensor_server_gone(
        {Errc::device,
         socket_.is_open()
             ? fmt::format("nothing of {} within {} ms", first->type, patience.count())
             : fmt::format("no answer within {} ms", patience.count())});
  }

  std::vector<Listed> sensors_;
  std::vector<int> accuracy_;
  WebSocket socket_;
  SourceHead head_{};
  std::optional<PhoneStreamMerge> merge_{};
  SensorMessage message_{};
  std::vector<std::string> early_{};  ///< messages that arrived during opening
  std::vector<Note> notes_{};
  std::uint64_t skipped_ = 0, noted_at_ = 1;
};

}  // namespace

Result<std::unique_ptr<Source>> open_sensor_server(SourceUri& uri, const OpenOptions& options) {
  std::vector<Listed> sensors;
  const std::string types = uri.value("type").value_or("accelerometer");
  for (const std::string_view word : words_of(types, ", "))
    sensors.push_back({fmt::format("{}{}", word.find('.') == word.npos ? android : "", word), 0});
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  if (sensors.empty())
    return Error{Errc::invalid_argument, "type=: expected a sensor such as accelerometer"};
  auto place = parse_host_port(uri.place());
  if (!place) return place.error();
  HostPort server = std::move(place).value();
  if (!server.port) server.port = sensor_server_port;
  auto source = std::make_unique<SensorServerSource>(std::move(server), std::move(sensors));
  if (const Status opened = source->open(uri.text(), options); !opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace proofmass::acquire
