#include "proofmass/io/messages/cdr_schema.hpp"

#include <charconv>
#include <fmt/format.h>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io {
namespace {

std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

bool is_rule(std::string_view line) {
  return line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos;
}

/// Types that need no definition: numbers, texts, and times.
bool is_built_in(std::string_view type) {
  constexpr std::string_view names =
      " bool byte char int8 uint8 int16 uint16 int32 uint32 int64 uint64 float32 float64 string "
      "wstring time duration ";
  return names.find(fmt::format(" {} ", type)) != std::string_view::npos;
}

/// The full name of a type in a field of a message of `package`.
std::string full_name(std::string_view type, std::string_view package) {
  if (is_built_in(type)) return std::string(type);
  if (type == "Header") return "std_msgs/Header";
  if (type.find('/') == std::string_view::npos) return fmt::format("{}/{}", package, type);
  return ros_name(type);
}

/// "float64[9]", "string<=10", "geometry_msgs/Point32[<=4]": the type before a field's name.
bool read_type(std::string_view word, std::string_view package, CdrField& field) {
  const std::size_t bracket = word.find('[');
  std::string_view type = word.substr(0, bracket);
  type = type.substr(0, type.find("<="));
  field.type = full_name(type, package);
  if (type.empty()) return false;
  if (bracket == std::string_view::npos) return true;
  std::string_view size = word.substr(bracket + 1);
  if (!size.ends_with(']')) return false;
  size.remove_suffix(1);
  field.many = CdrField::Many::sequence;
  if (size.empty() || size.starts_with("<=")) return true;
  field.many = CdrField::Many::array;
  const auto read = std::from_chars(size.data(), size.data() + size.size(), field.count);
  return read.ec == std::errc{} && read.ptr == size.data() + size.size() && field.count > 0;
}

/// One line of a definition; false if it is invalid.
bool read_line(std::string_view line, std::string_view package, std::vector<CdrField>& fields) {
  line = trimmed(line.substr(0, line.find('#')));
  if (line.empty()) return true;
  CdrField field;
  const std::string_view type = next_word(line);
  if (!read_type(type, package, field)) return false;
  const std::string_view name = next_word(line);
  line = trimmed(line);
  const bool is_constant = name.find('=') != std::string_view::npos || line.starts_with('=');
  if (is_constant) return true;
  field.name = name;
  if (!field.name.empty()) fields.push_back(std::move(field));
  return !name.empty();
}

std::string_view package_of(std::string_view name) {
  return name.substr(0, std::min(name.find('/'), name.size()));
}

/// Times are two numbers, whatever their name.
void add_times(CdrSchema& schema) {
  const std::vector<CdrField> stamp{{"sec", "int32"}, {"nanosec", "uint32"}};
  for (const char* name :
       {"time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration"})
    schema.messages[name] = stamp;
}

}  // namespace

std::string ros_name(std::string_view name) {
  const std::size_t first = name.find('/');
  const std::size_t last = name.rfind('/');
  if (first == last) return std::string(name);
  return fmt::format("{}/{}", name.substr(0, first), name.substr(last + 1));
}

Result<CdrSchema> read_cdr_schema(std::string_view name, std::string_view text) {
  constexpr std::size_t longest = std::size_t{1} << 20;
  if (text.size() > longest) return Error{Errc::corrupt, "its schema is longer than a mebibyte"};
  CdrSchema out;
  out.root = ros_name(name);
  std::string message = out.root;
  out.messages[message];
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (is_rule(line)) {
      message.clear();
      continue;
    }
    if (message.empty()) {
      if (line.empty()) continue;
      if (!line.starts_with("MSG:"))
        return Error{Errc::corrupt,
                     fmt::format("line {} of its schema: expected MSG: and a name", number)};
      message = ros_name(trimmed(line.substr(4)));
      out.messages[message];
      continue;
    }
    if (!read_line(line, package_of(message), out.messages[message]))
      return Error{Errc::corrupt,
                   fmt::format("line {} of its schema is not a field: {}", number, shown(line))};
  }
  add_times(out);
  return out;
}

}  // namespace proofmass::io
