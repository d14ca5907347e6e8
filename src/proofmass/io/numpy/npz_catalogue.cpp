#include "proofmass/io/numpy/npz_catalogue.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "proofmass/io/shown_text.hpp"

namespace proofmass::io {
namespace {

/// "float64", "int16", "bool"
std::string_view name_of(const FigureType& type) {
  constexpr std::array<std::string_view, 4> floats{"float16", "float32", "", "float64"};
  constexpr std::array<std::string_view, 4> wholes{"int16", "int32", "", "int64"};
  constexpr std::array<std::string_view, 4> unsigned_wholes{"uint16", "uint32", "", "uint64"};
  if (type.kind == 'b') return "bool";
  if (type.bytes == 1) return type.kind == 'u' ? "uint8" : "int8";
  const std::size_t place = std::min<std::size_t>(type.bytes / 2 - 1, 3);
  return type.kind == 'f'   ? floats[place]
         : type.kind == 'u' ? unsigned_wholes[place]
                            : wholes[place];
}

class Lister {
 public:
  explicit Lister(Archive& archive) : archive_(archive) { catalogue_.variables.version = "npz"; }

  NpzCatalogue run() {
    const auto entries = archive_.entries();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::string_view name = entries[i].name;
      if (!name.ends_with(".npy")) {
        leave_out(name, "no array");
      } else if (catalogue_.places.size() + catalogue_.variables.skipped.size() >=
                 matlab::most_arrays) {
        catalogue_.variables.is_cut = true;
        break;
      } else {
        add(i, name.substr(0, name.size() - 4));
      }
    }
    return std::move(catalogue_);
  }

 private:
  void leave_out(std::string_view name, std::string_view why) {
    if (catalogue_.variables.skipped.size() < matlab::most_arrays)
      catalogue_.variables.skipped.push_back(fmt::format("{} ({})", shown(name), why));
  }

  void add(std::size_t entry, std::string_view name) {
    const auto source = archive_.open(entry);
    if (!source) return leave_out(name, source.error().message);
    const auto preface = peek_npy_preface(**source);
    if (!preface) return leave_out(name, preface.error().message);
    const NpyHeader& header = preface->header;
    // An array with too many columns may be a transposed table.
    const bool is_wide = !header.is_structured && header.shape.size() > 1;
    auto layout = npy_layout(*preface, false);
    if (!layout && is_wide) layout = npy_layout(*preface, true);
    if (!layout)
      return leave_out(
          name, layout.error().code == Errc::too_few_samples ? "empty" : layout.error().message);
    if (!header.is_structured) {
      add_array(name, name.rfind('/'), header.shape, header.fields[0].type);
      catalogue_.places.push_back({entry, *preface, 0, std::nullopt});
      return;
    }
    add_fields(entry, name, *preface, layout->rows);
  }

  void add_fields(std::size_t entry,
                  std::string_view name,
                  const NpyPreface& preface,
                  std::size_t rows) {
    std::size_t column = 0;
    for (const NpyField& field : preface.header.fields) {
      if (field.type.kind == 0) continue;
      if (catalogue_.places.size() >= matlab::most_arrays) break;
      if (field.count <= rows) {
        add_array(fmt::format("{}.{}", name, field.name), name.size(), {rows, field.count},
                  field.type);
        catalogue_.places.push_back({entry, preface, column, field.count});
      }
      column += field.count;
    }
  }

  void add_array(std::string_view path,
                 std::size_t group_length,
                 std::vector<std::size_t> shape,
                 const FigureType& type) {
    while (shape.size() < 2) shape.push_back(1);
    matlab::Array array;
    array.path = shown(path);
    array.group_length = group_length == std::string_view::npos ? 0 : group_length;
    array.group_length = std::min(array.group_length, array.path.size());
    array.class_name = name_of(type);
    array.shape = std::move(shape);
    array.stored = type;
    catalogue_.variables.arrays.push_back(std::move(array));
  }

  Archive& archive_;
  NpzCatalogue catalogue_;
};

}  // namespace

NpzCatalogue list_npz(Archive& archive) {
  return Lister(archive).run();
}

}  // namespace proofmass::io
