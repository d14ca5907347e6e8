#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <unordered_map>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/json_leaves.hpp"
#include "proofmass/io/mcap/decoder.hpp"
#include "proofmass/io/messages/cdr_schema.hpp"
#include "proofmass/io/messages/clock.hpp"
#include "proofmass/io/messages/units.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {
namespace {

constexpr std::size_t longest_path = 256;
constexpr std::size_t most_figures = 4096;

/// Allows lookup of a path by a view.
struct PathHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view path) const {
    return std::hash<std::string_view>{}(path);
  }
};
using Places = std::unordered_map<std::string, std::size_t, PathHash, std::equal_to<>>;

bool is_second(std::string_view path) {
  return path.ends_with(".sec") || path.ends_with(".secs");
}
bool is_nanosecond(std::string_view path) {
  return path.ends_with(".nsec") || path.ends_with(".nsecs") || path.ends_with(".nanosec");
}
/// A stamp in the format of ROS and Foxglove: {"timestamp": {"sec": 1, "nsec": 5}}.
bool is_stamp_path(std::string_view path) {
  const std::string_view owner = path.substr(0, path.rfind('.'));
  return (is_second(path) || is_nanosecond(path)) &&
         (owner == "timestamp" || owner == "header.stamp" || owner == "stamp" || owner == "time");
}

/// The stamp's parts found in the current message.
struct StampParts {
  std::optional<std::int64_t> seconds;
  std::optional<std::int64_t> nanoseconds;

  void take(const JsonLeaf& leaf) {
    if (!leaf.whole) return;
    if (is_second(leaf.path)) seconds = leaf.whole;
    if (is_nanosecond(leaf.path)) nanoseconds = leaf.whole;
  }
  [[nodiscard]] std::optional<std::int64_t> ns() const {
    return seconds && nanoseconds ? stamp_ns(*seconds, *nanoseconds) : std::nullopt;
  }
};

/// Contents of the first message.
struct JsonLayout {
  std::vector<std::string> paths;
  StampParts stamp;
  std::string stamp_name;
};

Result<JsonLayout> layout_of(std::string_view message) {
  JsonLayout out;
  bool too_many = false;
  const Status visited = visit_json(message, [&](const JsonLeaf& leaf) {
    if (leaf.path.size() > longest_path || leaf.text ||
        leaf.path.find("covariance") != std::string_view::npos)
      return;
    if (is_stamp_path(leaf.path)) {
      out.stamp.take(leaf);
      out.stamp_name = leaf.path.substr(0, leaf.path.rfind('.'));
      return;
    }
    too_many = too_many || out.paths.size() == most_figures;
    if (!too_many) out.paths.emplace_back(leaf.path.empty() ? "value" : leaf.path);
  });
  if (!visited) return visited.error();
  if (too_many)
    return Error{Errc::unsupported,
                 fmt::format("in JSON of more than {} figures a message", most_figures)};
  if (out.paths.empty()) return Error{Errc::unsupported, "in JSON without figures"};
  return out;
}

/// True if a path belongs to a list of exactly three, "acc.2" without "acc.3": then those are x, y,
/// z.
bool is_in_triple(const std::vector<std::string>& paths, std::string_view list) {
  const auto has = [&](const char* number) {
    return std::ranges::find(paths, fmt::format("{}.{}", list, number)) != paths.end();
  };
  return has("0") && has("1") && has("2") && !has("3");
}

std::string common_heading(const std::vector<std::string>& paths,
                           const std::string& path,
                           std::string_view schema) {
  std::string name = path;
  const std::size_t dot = path.rfind('.');
  if (dot != std::string::npos && dot + 2 == path.size() && path[dot + 1] >= '0' &&
      path[dot + 1] <= '2' && is_in_triple(paths, std::string_view(path).substr(0, dot)))
    name[dot + 1] = static_cast<char>('x' + (path[dot + 1] - '0'));
  std::ranges::replace(name, '.', '_');
  name = shown(name);
  const std::string type =
      schema.ends_with("Imu") ? std::string("sensor_msgs/Imu") : ros_name(schema);
  const std::string_view unit =
      ros_unit(fmt::format("{}.{}", type, path.substr(0, path.find('.'))));
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

class JsonDecoder final : public Decoder {
 public:
  JsonDecoder(const JsonLayout& layout, const Topic& topic)
      : row_(layout.paths.size()),
        clock_(layout.stamp.ns(), topic.first.log_ns, layout.stamp_name) {
    head_.format = "MCAP";
    head_.headings.push_back(fmt::format("{} (ns)", clock_.name()));
    for (std::size_t c = 0; c < layout.paths.size(); ++c) {
      places_.emplace(layout.paths[c], c);
      // The search for neighbours is too slow for long lists.
      constexpr std::size_t few = 256;
      head_.headings.push_back(
          layout.paths.size() <= few
              ? common_heading(layout.paths, layout.paths[c], topic.schema.name)
              : shown(layout.paths[c]));
    }
    head_.columns = head_.headings.size();
    head_.stamps = clock_.declared();
    head_.notes.push_back(
        {Severity::info,
         fmt::format("the columns are the {} figures of the first message of {}; the time is {}",
                     layout.paths.size(), shown(topic.channel.topic), clock_.name())});
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }

  [[nodiscard]] Result<std::size_t> take(const Message& message, std::uint64_t) override {
    std::ranges::fill(row_, no_value);
    StampParts stamp;
    const Status visited = visit_json(message.data, [&](const JsonLeaf& leaf) {
      if (leaf.path.size() > longest_path || leaf.text) return;
      if (is_stamp_path(leaf.path)) {
        stamp.take(leaf);
        return;
      }
      const auto place = places_.find(leaf.path.empty() ? "value" : leaf.path);
      if (place != places_.end())
        row_[place->second] = leaf.figure;
      else if (leaf.path.find("covariance") == std::string_view::npos)
        ++further_;
    });
    if (!visited) return visited.error();
    time_ = clock_.take(stamp.ns(), message.log_ns);
    return std::size_t{1};
  }

  void copy(std::size_t,
            std::size_t count,
            std::span<const std::span<double>> into,
            std::size_t at) const override {
    if (count == 0) return;
    into[0][at] = time_;
    for (std::size_t c = 0; c < row_.size(); ++c) into[c + 1][at] = row_[c];
  }

  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes = clock_.notes();
    if (further_ > 0)
      notes.push_back({Severity::warning,
                       fmt::format("{} figures are skipped, as the first message has none of "
                                   "their names",
                                   further_)});
    return notes;
  }

 private:
  std::vector<double> row_;
  MessageClock clock_;
  Places places_;
  double time_ = 0.0;
  std::uint64_t further_ = 0;
  TableHead head_;
};

}  // namespace

Result<std::unique_ptr<Decoder>> json_decoder(const Topic& topic) {
  const auto layout = layout_of(topic.first.data);
  if (!layout) return layout.error();
  return std::unique_ptr<Decoder>(std::make_unique<JsonDecoder>(*layout, topic));
}

}  // namespace proofmass::io::mcap
