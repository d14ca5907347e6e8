#include "proofmass/simulate/rig/description.hpp"

#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace proofmass::simulate::description {

void fail(const toml::node& node,
          std::string_view key,
          std::string_view why,
          std::vector<Advice> advice) {
  throw Failure{{Errc::invalid_argument,
                 fmt::format("line {}: {} {}", node.source().begin.line, key, why),
                 std::move(advice)}};
}

void Fill::operator()(double& member) const {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) fail(node, key, "must be a number");
  member = *value * to_si;
}

void Fill::operator()(bool& member) const {
  const auto* value = node.as_boolean();
  if (value == nullptr) fail(node, key, "must be true or false");
  member = value->get();
}

void Fill::operator()(int& member) const {
  const auto* value = node.as_integer();
  if (value == nullptr || value->get() < -1000 || value->get() > 1000)
    fail(node, key, "must be a small whole number");
  member = static_cast<int>(value->get());
}

void Fill::operator()(std::uint64_t& member) const {
  const auto* value = node.as_integer();
  if (value == nullptr || value->get() < 0) fail(node, key, "must be a whole number, 0 or more");
  member = static_cast<std::uint64_t>(value->get());
}

void must_be_empty(const toml::table& table, std::string_view section) {
  if (!table.empty())
    fail(table.begin()->second, table.begin()->first.str(),
         fmt::format("is not a key of {}", section), {Advice{"print-config"}});
}

// The shortest decimal that reads back and converts to exactly `member`; the nearest if none does.
std::string value_text(double member, double to_si) {
  const double value = member / to_si;
  for (int digits = 1; digits < 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    double back = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    if (back * to_si == member) return fmt::format("{}", back);
  }
  return fmt::format("{}", value);
}

std::string value_text(bool member, double /*to_si*/) {
  return member ? "true" : "false";
}

std::string value_text(int member, double /*to_si*/) {
  return std::to_string(member);
}

std::string value_text(std::uint64_t member, double /*to_si*/) {
  return std::to_string(member);
}

std::string line(std::string_view key, std::string_view value, std::string_view why) {
  return fmt::format("{:<44} # {}\n", fmt::format("{} = {}", key, value), why);
}

Result<std::string> text_of(const std::string& path, std::string_view what) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    return Error{Errc::unreadable,
                 fmt::format("{}: cannot be read; expected {} (TOML)", path, what)};
  return text;
}

}  // namespace proofmass::simulate::description
