#include "proofmass/acquire/recorder/names.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <system_error>

namespace proofmass::acquire {
namespace {

/// The number in "run.0003.mcap" or "run.0003.mcap.part"; 0 if there is none.
unsigned long number_in(std::string_view name, std::string_view stem, std::string_view extension) {
  if (name.ends_with(".part")) name.remove_suffix(5);
  if (!name.starts_with(stem) || !name.ends_with(extension) ||
      name.size() < stem.size() + extension.size() + 2)
    return 0;
  const std::string_view digits =
      name.substr(stem.size() + 1, name.size() - stem.size() - extension.size() - 1);
  unsigned long number = 0;
  const char* const end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, number);
  constexpr unsigned long highest = 1'000'000'000;
  const bool is_number = name[stem.size()] == '.' && read.ec == std::errc{} && read.ptr == end;
  return is_number && number < highest ? number : 0;
}

}  // namespace

PartNames next_numbered(const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string stem = whole.stem().string();
  const std::string extension = whole.extension().string();
  const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : ".";
  unsigned long last = 0;
  std::error_code problem;  // a folder that cannot be listed will not accept a file either
  for (const auto& entry : std::filesystem::directory_iterator(folder, problem))
    last = std::max(last, number_in(entry.path().filename().string(), stem, extension));
  return part_names(
      (whole.parent_path() / fmt::format("{}.{:04}{}", stem, last + 1, extension)).string());
}

}  // namespace proofmass::acquire
