#include "proofmass/io/json_leaves.hpp"

#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

namespace proofmass::io {
namespace {

constexpr std::size_t deepest = 32;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Called by the parser with each element of the document; false stops it.
class Visitor {
 public:
  explicit Visitor(const std::function<void(const JsonLeaf&)>& visit) : visit_(visit) {}

  [[nodiscard]] const std::string& problem() const { return problem_; }

  // NOLINTBEGIN(readability-identifier-naming): the parser's names
  bool null() { return leaf({.path = {}, .figure = nan}); }
  bool boolean(bool value) {
    return leaf({.path = {}, .figure = value ? 1.0 : 0.0, .whole = std::int64_t{value}});
  }
  bool number_integer(std::int64_t value) {
    return leaf({.path = {}, .figure = static_cast<double>(value), .whole = value});
  }
  bool number_unsigned(std::uint64_t value) {
    JsonLeaf found{.path = {}, .figure = static_cast<double>(value)};
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      found.whole = static_cast<std::int64_t>(value);
    return leaf(found);
  }
  bool number_float(double value, const std::string&) {
    return leaf({.path = {}, .figure = value});
  }
  bool string(std::string& value) {
    return leaf({.path = {}, .figure = nan, .text = std::string_view(value)});
  }
  bool binary(std::vector<std::uint8_t>&) { return true; }
  bool start_object(std::size_t) { return enter(false); }
  bool key(std::string& name) {
    path_.resize(levels_.back().path_bytes);
    if (!path_.empty()) path_ += '.';
    path_ += name;
    return true;
  }
  bool end_object() { return leave(); }
  bool start_array(std::size_t) { return enter(true); }
  bool end_array() { return leave(); }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception&) {
    problem_ = fmt::format("is not JSON from its byte {} on", byte);
    return false;
  }
  // NOLINTEND(readability-identifier-naming)

 private:
  struct Level {
    std::size_t path_bytes = 0;
    bool is_list = false;
    std::size_t next = 0;  ///< for a list: index of the next element
  };

  /// In a list the path of the next element is its index.
  void count() {
    if (levels_.empty() || !levels_.back().is_list) return;
    path_.resize(levels_.back().path_bytes);
    if (!path_.empty()) path_ += '.';
    path_ += std::to_string(levels_.back().next++);
  }
  bool enter(bool is_list) {
    count();
    if (levels_.size() == deepest) {
      problem_ = fmt::format("is deeper than {} levels", deepest);
      return false;
    }
    levels_.push_back({path_.size(), is_list, 0});
    return true;
  }
  bool leave() {
    path_.resize(levels_.back().path_bytes);
    levels_.pop_back();
    return true;
  }
  bool leaf(JsonLeaf found) {
    count();
    found.path = path_;
    visit_(found);
    return true;
  }

  const std::function<void(const JsonLeaf&)>& visit_;
  std::string path_;
  std::vector<Level> levels_;
  std::string problem_;
};

}  // namespace

Status visit_json(std::string_view document, const std::function<void(const JsonLeaf&)>& visit) {
  Visitor visitor(visit);
  if (nlohmann::json::sax_parse(document.begin(), document.end(), &visitor)) return Done{};
  return Error{Errc::corrupt, visitor.problem()};
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace proofmass::io
