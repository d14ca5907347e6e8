#include "proofmass/io/matlab/mat_catalogue.hpp"

#include <fmt/format.h>

namespace proofmass::io::matlab {

std::string Array::description() const {
  std::string text;
  for (const std::size_t length : shape)
    text += fmt::format("{}{}", text.empty() ? "" : " x ", length);
  return fmt::format("{} {}{}", text, is_complex ? "complex " : "", class_name);
}

std::string name_from(std::string_view bytes) {
  std::string name(bytes.substr(0, bytes.find('\0')));
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name;
}

}  // namespace proofmass::io::matlab
