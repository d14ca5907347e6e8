#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/io/mcap/decoder.hpp"
#include "proofmass/io/messages/cdr_plan.hpp"
#include "proofmass/io/messages/clock.hpp"
#include "proofmass/io/messages/units.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {
namespace {

/// Converts the columns of a plan to rows of a table: the time first, without the plan's own stamp.
class RosDecoder final : public Decoder {
 public:
  RosDecoder(CdrPlan plan, CdrLayout layout, const Topic& topic)
      : plan_(std::move(plan)),
        layout_(layout),
        figures_(plan_.columns.size()),
        clock_(first_stamp(topic), topic.first.log_ns, stamp_name()) {
    head_.format = "MCAP";
    head_.headings.push_back(fmt::format("{} (ns)", clock_.name()));
    for (std::size_t c = 0; c < plan_.columns.size(); ++c) {
      if (is_stamp(c)) continue;
      kept_.push_back(c);
      const std::string_view unit = ros_unit(plan_.columns[c].parent);
      head_.headings.push_back(unit.empty() ? plan_.columns[c].path
                                            : fmt::format("{} ({})", plan_.columns[c].path, unit));
    }
    head_.columns = head_.headings.size();
    head_.stamps = clock_.declared();
    note_choices();
  }

  [[nodiscard]] bool has_columns() const { return !kept_.empty(); }
  [[nodiscard]] const TableHead& head() const override { return head_; }

  [[nodiscard]] Result<std::size_t> take(const Message& message, std::uint64_t) override {
    if (const Status decoded = decode_cdr(message.data, layout_, plan_, figures_); !decoded)
      return decoded.error();
    time_ = clock_.take(stamp(), message.log_ns);
    return std::size_t{1};
  }

  void copy(std::size_t,
            std::size_t count,
            std::span<const std::span<double>> into,
            std::size_t at) const override {
    if (count == 0) return;
    into[0][at] = time_;
    for (std::size_t c = 0; c < kept_.size(); ++c) into[c + 1][at] = figures_[kept_[c]];
  }

  [[nodiscard]] std::vector<Note> notes() const override { return clock_.notes(); }

 private:
  [[nodiscard]] bool is_stamp(std::size_t column) const {
    return plan_.stamp && (column == *plan_.stamp || column == *plan_.stamp + 1);
  }

  [[nodiscard]] std::optional<std::int64_t> stamp() const {
    if (!plan_.stamp) return std::nullopt;
    // 32-bit integers.
    return stamp_ns(static_cast<std::int64_t>(figures_[*plan_.stamp]),
                    static_cast<std::int64_t>(figures_[*plan_.stamp + 1]));
  }

  std::optional<std::int64_t> first_stamp(const Topic& topic) {
    if (!decode_cdr(topic.first.data, layout_, plan_, figures_)) return std::nullopt;
    return stamp();
  }

  [[nodiscard]] std::string stamp_name() const {
    if (!plan_.stamp) return "log_time";
    constexpr std::string_view seconds = "_sec";
    const std::string& path = plan_.columns[*plan_.stamp].path;
    return path.substr(0, path.size() - seconds.size());
  }

  void note_choices() {
    head_.notes.push_back(
        {Severity::info,
         clock_.has_stamps()
             ? fmt::format("the time is {}, which the device set", clock_.name())
             : std::string(
                   "the time is log_time, which the host set: the messages bring no stamp")});
    if (!plan_.skipped.empty())
      head_.notes.push_back({Severity::info, fmt::format("covariances and lists are skipped: {}",
                                                         fmt::join(plan_.skipped, ", "))});
  }

  CdrPlan plan_;
  CdrLayout layout_;
  std::vector<double> figures_;  ///< values of the message, in the plan's columns
  MessageClock clock_;
  std::vector<std::size_t> kept_;  ///< columns of the plan that are not the stamp
  double time_ = 0.0;
  TableHead head_;
};

}  // namespace

Result<std::unique_ptr<Decoder>> ros_decoder(const Topic& topic) {
  const bool is_ros1 = topic.channel.encoding == "ros1";
  const std::string_view wanted = is_ros1 ? "ros1msg" : "ros2msg";
  if (topic.schema.encoding != wanted)
    return Error{Errc::unsupported,
                 fmt::format("of type {}, whose schema is in {} and not in {}",
                             shown(topic.schema.name), shown(topic.schema.encoding), wanted)};
  const auto schema = read_cdr_schema(topic.schema.name, topic.schema.data);
  if (!schema) return schema.error();
  auto plan = plan_cdr(*schema);
  if (!plan) return plan.error();
  auto decoder = std::make_unique<RosDecoder>(std::move(plan).value(),
                                              is_ros1 ? CdrLayout::ros1 : CdrLayout::xcdr, topic);
  if (!decoder->has_columns())
    return Error{Errc::unsupported, "whose only figures are a time stamp"};
  return std::unique_ptr<Decoder>(std::move(decoder));
}

}  // namespace proofmass::io::mcap
