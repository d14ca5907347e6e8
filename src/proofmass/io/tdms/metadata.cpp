#include "proofmass/io/tdms/metadata.hpp"

#include <array>
#include <string_view>

#include "proofmass/io/tdms/cursor.hpp"
#include "proofmass/io/tdms/index.hpp"
#include "proofmass/io/tdms/properties.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr std::uint32_t no_values = 0xFFFFFFFF;
constexpr std::uint32_t as_before = 0;

/// The names in a path: "/'Dr. T''s Events'/'Time'".
std::vector<std::string> names_in(std::string_view path) {
  std::vector<std::string> names;
  while (path.starts_with("/'")) {
    path.remove_prefix(2);
    std::string name;
    while (!path.empty()) {
      const bool is_quote = path.front() == '\'';
      if (is_quote && !path.starts_with("''")) break;
      name += path.front();
      path.remove_prefix(is_quote ? 2 : 1);
    }
    if (!path.empty()) path.remove_prefix(1);
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

std::uint32_t Metadata::object_of(const std::string& path) {
  const auto [found, is_new] =
      by_path_.try_emplace(path, static_cast<std::uint32_t>(objects_.size()));
  if (!is_new) return found->second;
  std::vector<std::string> names = names_in(path);
  Object object;
  if (!names.empty()) object.group = std::move(names[0]);
  if (names.size() > 1) object.name = std::move(names[1]);
  if (object.group.empty() && path != "/") object.name = path;
  objects_.push_back(std::move(object));
  last_index_.emplace_back();
  index_now_.emplace_back();
  is_listed_.push_back(false);
  return found->second;
}

std::uint32_t Metadata::known_index(const Index& index) {
  const auto [found, is_new] =
      by_index_.try_emplace(key_of(index), static_cast<std::uint32_t>(indices_.size()));
  if (is_new) indices_.push_back(std::make_unique<const Index>(index));
  return found->second;
}

void Metadata::list(std::uint32_t object, std::optional<std::uint32_t> index) {
  if (!is_listed_[object]) listed_.push_back(object);
  is_listed_[object] = true;
  index_now_[object] = index;
}

Status Metadata::read_index(Cursor& cursor, std::uint32_t object) {
  const std::uint64_t at = cursor.position();
  const auto header = cursor.take<std::uint32_t>();
  if (header == no_values) {
    list(object, std::nullopt);
    return Done{};
  }
  if (header == as_before) {
    if (!last_index_[object] && !cursor.broken())
      return at_byte(at, "a channel like in the segment before, where it is not");
    list(object, last_index_[object]);
    return Done{};
  }
  const auto read = take_index(cursor, header);
  if (!read) return read.error();
  if (cursor.broken()) return Done{};
  last_index_[object] = known_index(*read);
  list(object, last_index_[object]);
  note_kind(object, *read);
  return Done{};
}

void Metadata::note_kind(std::uint32_t object, const Index& index) {
  Object& known = objects_[object];
  if (!known.has_index) {
    known.kind = index.kind;
    known.type = index.type;
  }
  const auto class_of = [](Kind kind) { return kind < Kind::instant ? Kind::f64 : kind; };
  known.changes_kind = known.changes_kind || class_of(known.kind) != class_of(index.kind);
  known.has_index = true;
}

Status Metadata::read_object(Cursor& cursor) {
  const std::string path = cursor.take_text();
  if (cursor.broken()) return Done{};
  const std::uint32_t object = object_of(path);
  if (const Status read = read_index(cursor, object); !read) return read;
  return read_properties(cursor, objects_[object].properties);
}

Status Metadata::read(Cursor& cursor, bool new_list) {
  if (new_list) {
    for (const std::uint32_t object : listed_) is_listed_[object] = false;
    listed_.clear();
  }
  const auto count = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !cursor.broken(); ++i)
    if (const Status read = read_object(cursor); !read) return read;
  return Done{};
}

std::vector<Part> Metadata::parts() const {
  std::vector<Part> parts;
  for (const std::uint32_t object : listed_)
    if (index_now_[object]) parts.push_back({object, indices_[*index_now_[object]].get()});
  return parts;
}

std::string Metadata::key() const {
  std::string key;
  for (const std::uint32_t object : listed_) {
    if (!index_now_[object]) continue;
    const std::array<std::uint32_t, 2> pair{object, *index_now_[object]};
    key.append(reinterpret_cast<const char*>(pair.data()), sizeof pair);
  }
  return key;
}

}  // namespace proofmass::io::tdms
