#include "proofmass/thesis/chapters.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace proofmass::thesis {
namespace {

// Source: the thesis's table of contents.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> titles{{
    {"2", "Chapter 2. Robot Localization"},
    {"4", "Chapter 4. Software System Design"},
    {"5", "Chapter 5. Results and Discussions"},
    {"6", "Chapter 6. Conclusion and Recommendations"},
    {"A", "Appendix A"},
}};

std::string title_of(const std::string& key) {
  const auto found = std::ranges::find(titles, key, [](const auto& one) { return one.first; });
  return found != titles.end() ? std::string(found->second) : "Chapter " + key;
}

}  // namespace

std::string chapter_key(const Item& item) {
  const std::size_t number = item.id.find(' ') + 1;  // npos + 1 is 0: the whole of it
  return item.id.substr(number, item.id.find('.', number) - number);
}

std::vector<Chapter> chapters(const std::vector<Item>& items) {
  std::vector<Chapter> out;
  for (const Item& item : items) {
    const std::string key = chapter_key(item);
    auto chapter = std::ranges::find(out, key, &Chapter::key);
    if (chapter == out.end()) chapter = out.insert(out.end(), {key, title_of(key), {}});
    chapter->items.push_back(&item);
  }
  return out;
}

}  // namespace proofmass::thesis
