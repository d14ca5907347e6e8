#include "proofmass/io/tdms/map.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "proofmass/io/tdms/cursor.hpp"
#include "proofmass/io/tdms/lead_in.hpp"
#include "proofmass/io/tdms/metadata.hpp"

namespace proofmass::io::tdms {
namespace {

/// Limit for all layouts together: twenty channels may change the lengths of their chunks 25 000
/// times.
constexpr std::size_t most_layout_entries = std::size_t{1} << 20;
constexpr std::size_t longest_compared = 16 << 10;

class Walk {
 public:
  explicit Walk(const RandomBytes& bytes) : size_(bytes.size()), cursor_(bytes) {}

  Result<Map> run() {
    for (std::uint64_t at = 0; at < size_;) {
      const auto segment = take_segment(at);
      if (cursor_.failure()) return *cursor_.failure();
      if (!segment) {
        if (map_.segments == 0) return segment.error();
        map_.notes.push_back(
            {Severity::bad, segment.error().message + "; what stands before it is read"});
        break;
      }
      at = *segment;
    }
    if (map_.segments == 0) return Error{Errc::corrupt, "byte 0: expected a segment (TDSm)"};
    count_values();
    map_.objects = std::move(metadata_.objects());
    for (std::uint32_t i = 0; i < map_.objects.size(); ++i)
      if (map_.objects[i].name.empty()) map_.groups.emplace(map_.objects[i].group, i);
    return std::move(map_);
  }

 private:
  static Error at_byte(std::uint64_t at, std::string_view what) {
    return {Errc::corrupt, fmt::format("byte {}: {}", at, what)};
  }

  /// Reads one segment; returns the start of the next.
  Result<std::uint64_t> take_segment(std::uint64_t at) {
    const auto lead = take_lead_in(cursor_, at, size_);
    if (!lead) return lead.error();
    if (lead->version != 4712 && lead->version != 4713 && !noted_version_) {
      noted_version_ = true;
      map_.notes.push_back({Severity::warning, fmt::format("byte {}: version {} of TDMS: 4712 and "
                                                           "4713 are known",
                                                           at + 8, lead->version)});
    }
    if (lead->has(LeadIn::metadata))
      if (const Status read = take_metadata(*lead); !read) return read.error();
    ++map_.segments;
    const std::size_t notes_before = map_.notes.size();
    if (lead->has(LeadIn::raw_data) && lead->end > lead->raw_at)
      if (const Status added = add_data(*lead); !added) return added.error();
    if (!lead->is_complete && map_.notes.size() == notes_before) note_end(*lead);
    return lead->end;
  }

  /// Notes a file that ends with a whole chunk, but not where its last segment should end.
  void note_end(const LeadIn& lead) {
    if (lead.is_unfinished)
      map_.notes.push_back(
          {Severity::warning,
           fmt::format("byte {}: the program that wrote the file did not close it; all values that "
                       "are there are read",
                       lead.at)});
    else
      map_.notes.push_back(
          {Severity::bad,
           fmt::format("byte {}: the file breaks off before the end of its last segment", size_)});
  }

  Status take_metadata(const LeadIn& lead) {
    const std::uint64_t from = lead.at + LeadIn::bytes;
    const std::uint64_t length = lead.raw_at - from;
    cursor_.enter(from, lead.end, lead.has(LeadIn::big_endian));
    std::string same;
    if (length > 0 && length <= longest_compared) {
      cursor_.skip(length);
      same = cursor_.copy_since(from, longest_compared);
      if (same == previous_metadata_ && lead.contents == previous_contents_) return Done{};
      cursor_.enter(from, lead.end, lead.has(LeadIn::big_endian));
    }
    layout_.reset();
    const Status read = metadata_.read(cursor_, lead.has(LeadIn::new_list));
    if (!read) return read;
    const bool overran = lead.has(LeadIn::raw_data) && cursor_.position() > lead.raw_at;
    if (cursor_.broken() || overran)
      return at_byte(lead.at, lead.is_complete
                                  ? "the metadata of the segment are longer than it says"
                                  : "the file breaks off within the metadata of the segment");
    previous_metadata_ = std::move(same);
    previous_contents_ = lead.contents;
    return Done{};
  }

  /// The layout of the current list of objects, computed only if it is new.
  Result<std::uint32_t> layout_of(const LeadIn& lead) {
    const std::uint32_t order_bits = lead.contents & (LeadIn::interleaved | LeadIn::big_endian);
    if (layout_ && order_bits == layout_bits_) return *layout_;
    const std::vector<Part> parts = metadata_.parts();
    RawDataOrder order{lead.has(LeadIn::interleaved), lead.has(LeadIn::big_endian)};
    order.other_bytes = infer_other_bytes(parts, lead.end - lead.raw_at);
    const bool has_other = std::ranges::any_of(
        parts, [](const Part& part) { return part.index->kind == Kind::other; });
    if (!has_other) order.other_bytes = 0;
    const std::string key = fmt::format("{}/{}/", order_bits, order.other_bytes) + metadata_.key();
    auto found = by_key_.find(key);
    if (found == by_key_.end()) {
      auto made = lay_out(parts, order);
      if (!made) return at_place(made.error(), lead.at);
      const auto kept = keep(std::move(made).value(), lead.at);
      if (!kept) return kept.error();
      found = by_key_.emplace(key, *kept).first;
    }
    if (!has_other) layout_ = found->second;
    layout_bits_ = order_bits;
    return found->second;
  }

  static Error at_place(const Error& error, std::uint64_t at) {
    return {error.code, fmt::format("byte {}: the segment {}", at, error.message)};
  }

  Result<std::uint32_t> keep(Layout layout, std::uint64_t at) {
    layout_entries_ += layout.size();
    if (layout_entries_ > most_layout_entries)
      return Error{Errc::unsupported,
                   fmt::format("byte {}: the layout of the segments changes too often", at)};
    map_.layouts.push_back(std::move(layout));
    return static_cast<std::uint32_t>(map_.layouts.size() - 1);
  }

  Status add_data(const LeadIn& lead) {
    const auto layout = layout_of(lead);
    if (!layout) return layout.error();
    const std::uint64_t data = lead.end - lead.raw_at;
    const std::uint64_t chunk = map_.layouts[*layout].chunk_bytes;
    if (chunk == 0) {
      map_.notes.push_back(
          {Severity::bad, fmt::format("byte {}: {} bytes of values that belong to no channel",
                                      lead.raw_at, data)});
      return Done{};
    }
    ++map_.data_segments;
    if (data >= chunk) add_run({lead.raw_at, 0, 1, data / chunk, *layout});
    const std::uint64_t rest = data % chunk;
    return rest == 0 ? Status(Done{}) : add_rest(lead, *layout, rest);
  }

  /// Adds the incomplete last chunk of a segment.
  Status add_rest(const LeadIn& lead, std::uint32_t whole, std::uint64_t rest) {
    std::optional<Layout> part;
    if (lead.is_complete) part = in_proportion(map_.layouts[whole], rest);
    const bool even = part.has_value();
    if (!even) part = broken_off(map_.layouts[whole], rest);
    const auto kept = keep(std::move(*part), lead.at);
    if (!kept) return kept.error();
    if (!even) note_broken(lead, whole, *kept);
    add_run({lead.end - rest, 0, 1, 1, *kept});
    return Done{};
  }

  void note_broken(const LeadIn& lead, std::uint32_t whole, std::uint32_t part) {
    std::uint64_t lost = 0;
    std::uint32_t channels = 0;
    for (std::size_t i = 0; i < map_.layouts[whole].entries.size(); ++i) {
      const Entry& entry = map_.layouts[whole].entries[i];
      const std::uint64_t gone = entry.values - map_.layouts[part].entries[i].values;
      if (i > 0 && map_.layouts[whole].entries[i - 1].channel == entry.channel) continue;
      if (gone == 0) continue;
      ++channels;
      lost = std::max(lost, gone);
      if (metadata_.objects()[entry.channel].promised <= size_)
        metadata_.objects()[entry.channel].promised += std::min(gone, size_);
    }
    map_.notes.push_back(
        {Severity::bad,
         fmt::format("byte {}: {} within a chunk of values: {} of the {} channels in it lack up to "
                     "{} values",
                     lead.end, lead.is_complete ? "the segment ends" : "the file breaks off",
                     channels, distinct_channels(whole), lost)});
  }

  std::size_t distinct_channels(std::uint32_t layout) const {
    std::size_t count = 0;
    const auto& entries = map_.layouts[layout].entries;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (i == 0 || entries[i].channel != entries[i - 1].channel) ++count;
    return count;
  }

  /// Extends the previous run if the new one continues it.
  void add_run(const Run& next) {
    if (!map_.runs.empty()) {
      Run& last = map_.runs.back();
      const std::uint64_t distance =
          next.data_at - (last.data_at + (last.segments - 1) * last.distance);
      if (last.layout == next.layout && last.chunks == next.chunks &&
          (last.segments == 1 || last.distance == distance)) {
        last.distance = distance;
        ++last.segments;
        return;
      }
    }
    map_.runs.push_back(next);
  }

  void count_values() {
    std::vector<std::uint64_t> chunks(map_.layouts.size());
    for (const Run& run : map_.runs) chunks[run.layout] += run.segments * run.chunks;
    for (std::size_t l = 0; l < chunks.size(); ++l) {
      const auto& entries = map_.layouts[l].entries;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i > 0 && entries[i].channel == entries[i - 1].channel) continue;
        Object& object = metadata_.objects()[entries[i].channel];
        std::uint64_t values = 0;
        if (__builtin_mul_overflow(entries[i].values, chunks[l], &values) || values > size_)
          values = size_;
        object.values += values;
      }
    }
    for (Object& object : metadata_.objects()) object.promised += object.values;
  }

  std::uint64_t size_;
  Cursor cursor_;
  Metadata metadata_;
  Map map_;
  std::string previous_metadata_;
  std::uint32_t previous_contents_ = 0;
  std::unordered_map<std::string, std::uint32_t> by_key_;
  std::optional<std::uint32_t> layout_;  ///< layout of the current list, if it is known
  std::uint32_t layout_bits_ = 0;
  std::size_t layout_entries_ = 0;
  bool noted_version_ = false;
};

}  // namespace

const Properties& Map::properties_of(const std::string& group) const {
  static const Properties none;
  const auto found = groups.find(group);
  return found == groups.end() ? none : objects[found->second].properties;
}

Result<Map> map_file(const RandomBytes& bytes) {
  return Walk(bytes).run();
}

}  // namespace proofmass::io::tdms
