#include "proofmass/io/messages/cdr_plan.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/io/shown_text.hpp"

namespace proofmass::io {
namespace {

struct Built {
  std::string_view type;
  char kind;
  std::size_t bytes;
};
constexpr std::array<Built, 13> figures{{{"bool", 'u', 1},
                                         {"byte", 'u', 1},
                                         {"char", 'u', 1},
                                         {"int8", 'i', 1},
                                         {"uint8", 'u', 1},
                                         {"int16", 'i', 2},
                                         {"uint16", 'u', 2},
                                         {"int32", 'i', 4},
                                         {"uint32", 'u', 4},
                                         {"int64", 'i', 8},
                                         {"uint64", 'u', 8},
                                         {"float32", 'f', 4},
                                         {"float64", 'f', 8}}};

bool is_time(std::string_view type) {
  return type == "time" || type == "builtin_interfaces/Time";
}

class Planner {
 public:
  explicit Planner(const CdrSchema& schema) : schema_(schema) {}

  Result<CdrPlan> run() {
    if (const Status added = add_message(schema_.root, {}, plan_.steps, true); !added)
      return added.error();
    if (plan_.columns.empty())
      return Error{Errc::unsupported,
                   fmt::format("of type {}, which holds no single figure", schema_.root)};
    if (wide_text_at_ && plan_.columns.size() > *wide_text_at_)
      return Error{Errc::unsupported, "it holds text of wide characters before its last figure"};
    while (!plan_.steps.back().column) plan_.steps.pop_back();
    return std::move(plan_);
  }

 private:
  static constexpr std::size_t deepest = 16;
  static constexpr std::size_t most_steps = 4096;
  static constexpr std::uint32_t most_in_array = 16;

  /// Location of a field.
  struct Place {
    std::string path;    ///< path of the enclosing message
    std::string parent;  ///< as in CdrColumn
    std::size_t depth = 0;
  };

  Status add_message(const std::string& type,
                     const Place& place,
                     std::vector<CdrStep>& steps,
                     bool has_columns) {
    const auto found = schema_.messages.find(type);
    if (found == schema_.messages.end())
      return Error{Errc::corrupt, fmt::format("its schema does not define {}", shown(type))};
    if (place.depth == deepest)
      return Error{Errc::corrupt, "its schema is deeper than 16 messages"};
    if (is_time(type)) note_stamp(place, has_columns);
    // ROS 2 stores a byte for a message without fields.
    if (found->second.empty()) return add_figures({"", "uint8"}, {}, steps, false);
    for (const CdrField& field : found->second) {
      const std::string parent = fmt::format("{}.{}", type, field.name);
      const bool has_unit = place.parent.empty() || has_own_unit(type);
      const Place within{place.path.empty() ? field.name : place.path + "_" + field.name,
                         has_unit ? parent : place.parent, place.depth + 1};
      if (const Status added = add_field(field, within, steps, has_columns); !added) return added;
    }
    return Done{};
  }

  /// A vector's numbers have the quantity of the vector field.
  static bool has_own_unit(std::string_view type) {
    return type != "geometry_msgs/Vector3" && type != "geometry_msgs/Point" &&
           type != "geometry_msgs/Quaternion";
  }

  Status add_field(const CdrField& field,
                   const Place& place,
                   std::vector<CdrStep>& steps,
                   bool has_columns) {
    if (++steps_ > most_steps)
      return Error{Errc::unsupported, "its schema has more than 4096 fields"};
    // The size of a wide character is not specified.
    if (field.type == "wstring" && !wide_text_at_) wide_text_at_ = plan_.columns.size();
    if (field.type == "string" || field.type == "wstring") {
      steps.push_back({.what = CdrStep::What::text,
                       .is_sequence = field.many == CdrField::Many::sequence,
                       .count = field.count});
      return Done{};
    }
    if (std::ranges::find(figures, std::string_view(field.type), &Built::type) != figures.end())
      return add_figures(field, place, steps, has_columns);
    if (field.many == CdrField::Many::one)
      return add_message(field.type, place, steps, has_columns);
    CdrStep loop{.what = CdrStep::What::messages,
                 .is_sequence = field.many == CdrField::Many::sequence,
                 .count = field.count};
    if (has_columns) skip(place.path);
    const Status added = add_message(field.type, place, loop.inner, false);
    steps.push_back(std::move(loop));
    return added;
  }

  Status add_figures(const CdrField& field,
                     const Place& place,
                     std::vector<CdrStep>& steps,
                     bool has_columns) {
    const Built& type = *std::ranges::find(figures, std::string_view(field.type), &Built::type);
    CdrStep step{.kind = type.kind,
                 .bytes = type.bytes,
                 .is_sequence = field.many == CdrField::Many::sequence,
                 .count = field.count};
    const bool is_column = has_columns && !step.is_sequence && step.count > 0 &&
                           step.count <= most_in_array && !field.name.ends_with("covariance");
    if (is_column) {
      step.column = plan_.columns.size();
      for (std::uint32_t i = 0; i < step.count; ++i)
        plan_.columns.push_back(
            {field.many == CdrField::Many::one ? place.path : fmt::format("{}_{}", place.path, i),
             place.parent});
    } else if (has_columns) {
      skip(place.path);
    }
    steps.push_back(std::move(step));
    return Done{};
  }

  void note_stamp(const Place& place, bool has_columns) {
    if (!has_columns || plan_.stamp) return;
    const bool is_stamp =
        place.path.ends_with("stamp") || place.path == "time" || place.path == "time_ref";
    if (is_stamp && place.depth <= 2) plan_.stamp = plan_.columns.size();
  }

  void skip(const std::string& path) {
    constexpr std::size_t most = 8;
    if (plan_.skipped.size() < most) plan_.skipped.push_back(path);
  }

  const CdrSchema& schema_;
  CdrPlan plan_;
  std::size_t steps_ = 0;
  std::optional<std::size_t> wide_text_at_;  ///< number of columns before the first of them
};

}  // namespace

Result<CdrPlan> plan_cdr(const CdrSchema& schema) {
  return Planner(schema).run();
}

}  // namespace proofmass::io
