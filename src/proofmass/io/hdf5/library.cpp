#include "proofmass/io/hdf5/library.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <set>

#include "proofmass/io/hdf5/attributes.hpp"
#include "proofmass/io/hdf5/fields.hpp"
#include "proofmass/io/hdf5/handle.hpp"
#include "proofmass/io/hdf5/labels.hpp"
#include "proofmass/io/hdf5/runs.hpp"
#include "proofmass/io/hdf5/storage.hpp"

namespace proofmass::io::hdf5 {
namespace {

constexpr int deepest = 16;

/// Location of an object.
struct Place {
  std::string path;
  std::string address;
  std::size_t group_length = 0;
  int depth = 0;
};

Place member(const Place& group, const std::string& name, bool is_matlab) {
  const char separator = is_matlab ? '.' : '/';
  return {group.path.empty() ? name : group.path + separator + name, group.address + '/' + name,
          group.path.size(), group.depth + 1};
}

class Lister {
 public:
  explicit Lister(bool is_matlab) : is_matlab_(is_matlab) {}

  /// An object with several names is listed under the first.
  void visit_object(hid_t object, const Place& place) {
    H5O_info_t info;
    if (H5Oget_info(object, &info) < 0) return skip(place, "damaged");
    if (!visited_.insert(info.addr).second) return;
    const H5I_type_t kind = H5Iget_type(object);
    if (kind == H5I_GROUP) visit_group(object, place);
    if (kind == H5I_DATASET) visit_dataset(object, place);
  }

  [[nodiscard]] Catalogue take() { return std::move(catalogue_); }

 private:
  struct Members {
    Lister* lister;
    const Place* place;
    hid_t group;
    std::vector<std::string> names;
  };

  /// Called by the library, which exceptions must not cross.
  static herr_t collect(hid_t, const char* name, const H5L_info_t* link, void* into) noexcept {
    Members& members = *static_cast<Members*>(into);
    if (++members.lister->objects_ > most_objects) {
      members.lister->catalogue_.is_cut = true;
      return 1;
    }
    const Place place = member(*members.place, name, members.lister->is_matlab_);
    if (link->type == H5L_TYPE_HARD)
      members.names.emplace_back(name);
    else
      members.lister->skip(place, "link");
    return 0;
  }

  void visit_group(hid_t group, const Place& place) {
    if (is_matlab_ && !place.path.empty() && has_attribute(group, "MATLAB_sparse")) {
      skip(place, "sparse");
      return;
    }
    if (place.depth > deepest) {
      skip(place, "nested too deeply");
      return;
    }
    keep_attributes(group, place.path);
    Members members{this, &place, group, {}};
    hsize_t index = 0;
    H5Literate(group, order_of(group), H5_ITER_INC, &index, collect, &members);
    for (const std::string& name : members.names) visit(group, name, place);
  }

  /// In the order of creation, if the group stores it; else by name.
  static H5_index_t order_of(hid_t group) {
    const Handle creation(H5Gget_create_plist(group), H5Pclose);
    unsigned kept = 0;
    const bool is_kept = creation && H5Pget_link_creation_order(creation, &kept) >= 0 &&
                         (kept & H5P_CRT_ORDER_INDEXED) != 0;
    return is_kept ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  }

  void visit(hid_t group, const std::string& name, const Place& parent) {
    if (is_matlab_ && parent.path.empty() && name.starts_with('#')) return;
    const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    const Place place = member(parent, name, is_matlab_);
    if (!object)
      skip(place, "damaged");
    else
      visit_object(object, place);
  }

  void visit_dataset(hid_t dataset, const Place& place) {
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    if (!type || !space) return skip(place, "damaged");
    if (!is_matlab_ && holds_runs(dataset)) {
      if (!read_runs(dataset, catalogue_)) skip(place, "labels that cannot be read");
      return;
    }
    const std::string class_name = is_matlab_ ? text_attribute(dataset, "MATLAB_class") : "";
    if (is_matlab_ && H5Tget_class(type) == H5T_REFERENCE)
      return visit_references(dataset, class_name == "cell", place);
    std::string stored = type_name(type);
    const CompoundFields fields =
        stored.empty() && !is_matlab_ ? fields_of(type) : CompoundFields{};
    const bool is_compound = !fields.numeric.empty();
    if (is_compound) stored = "compound";
    if (const std::string refusal = refusal_of(dataset, type, stored, class_name); !refusal.empty())
      return skip(place, refusal);
    Dataset found{.path = place.path, .address = place.address, .type = stored};
    if (!class_name.empty()) found.type = class_name;
    found.group_length = place.group_length;
    found.is_complex = stored == "complex";
    if (!read_shape(space, found)) return skip(place, "damaged");
    if (is_compound && !keep_fields(fields, place, found)) return;
    const bool is_single =
        std::ranges::all_of(found.shape, [](auto length) { return length == 1; });
    if (is_single && !found.is_complex && !is_compound) found.figure = figure_of(dataset);
    catalogue_.datasets.push_back(std::move(found));
    keep_attributes(dataset, place.path);
  }

  static bool read_shape(hid_t space, Dataset& into) {
    std::array<hsize_t, H5S_MAX_RANK> lengths{};
    const int rank = H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
    if (rank < 0) return false;
    into.shape.assign(lengths.begin(), lengths.begin() + rank);
    return true;
  }

  /// Makes columns of the fields of a compound type, and names them; false if it is not a table.
  bool keep_fields(const CompoundFields& fields, const Place& place, Dataset& found) {
    for (const std::string& other : fields.others) skip(place.path + '/' + other);
    if (found.shape.size() != 1 || fields.columns() > matlab::most_channels) {
      skip(place, found.shape.size() != 1 ? "compound, of several dimensions"
                                          : "compound, of more than 64 columns");
      return false;
    }
    found.is_compound = true;
    found.shape.push_back(fields.columns());
    Attribute columns{.owner = place.path, .name = "columns"};
    for (const NumericField& field : fields.numeric)
      std::ranges::move(names_by_place(field.name, field.columns),
                        std::back_inserter(columns.texts));
    if (catalogue_.attributes.size() < most_objects)
      catalogue_.attributes.push_back(std::move(columns));
    return true;
  }

  /// The reason why a dataset is not read; empty if it is.
  static std::string refusal_of(hid_t dataset,
                                hid_t type,
                                const std::string& stored,
                                const std::string& class_name) {
    std::string refusal = meaning_refusal(dataset, class_name);
    if (refusal.empty() && stored.empty()) refusal = kind_of(type);
    return refusal.empty() ? storage_refusal(dataset) : refusal;
  }

  /// The reason why a dataset is not numeric despite its storage type; empty if it is.
  static std::string meaning_refusal(hid_t dataset, const std::string& class_name) {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    if (H5Sget_simple_extent_type(space) == H5S_NULL || has_attribute(dataset, "MATLAB_empty"))
      return "empty";
    if (class_name == "char") return "text";
    if (class_name == "function_handle" || has_attribute(dataset, "MATLAB_object_decode"))
      return "object";
    // Source: Unidata, "NetCDF-4 format", on dimensions without coordinate variables.
    if (text_attribute(dataset, "NAME").starts_with("This is a netCDF dimension but not"))
      return "dimension";
    return {};
  }

  static std::optional<double> figure_of(hid_t dataset) {
    double figure = 0.0;
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &figure) < 0)
      return std::nullopt;
    return figure;
  }

  /// Cells, "parts{2}", and the fields of an array of structs, "runs(2).acc", are references.
  void visit_references(hid_t dataset, bool is_cell, const Place& place) {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 0 || static_cast<std::size_t>(count) > most_objects ||
        H5Tequal(type, H5T_STD_REF_OBJ) <= 0 || place.depth > deepest)
      return skip(place, "references");
    std::vector<hobj_ref_t> references(static_cast<std::size_t>(count));
    if (H5Dread(dataset, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, references.data()) < 0)
      return skip(place, "damaged");
    for (std::size_t i = 0; i < references.size(); ++i) {
      if (++objects_ > most_objects) {
        catalogue_.is_cut = true;
        return;
      }
      const Handle object(H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, &references[i]),
                          H5Oclose);
      Place target = referred(place, i + 1, is_cell);
      std::array<char, 1024> address{};
      if (!object ||
          H5Rget_name(dataset, H5R_OBJECT, &references[i], address.data(), address.size()) <= 0) {
        skip(target, "damaged");
        continue;
      }
      address.back() = '\0';
      target.address = address.data();
      visit_object(object, target);
    }
  }

  static Place referred(const Place& place, std::size_t number, bool is_cell) {
    Place target;
    target.depth = place.depth + 1;
    const std::string group = place.path.substr(0, place.group_length);
    if (is_cell || group.empty()) {
      target.path = fmt::format("{}{{{}}}", place.path, number);
      target.group_length = place.path.size();
    } else {
      const std::string element = fmt::format("{}({})", group, number);
      target.path = element + place.path.substr(place.group_length);
      target.group_length = element.size();
    }
    return target;
  }

  void keep_attributes(hid_t object, const std::string& owner) {
    for (Attribute& attribute : attributes_of(object)) {
      if (catalogue_.attributes.size() >= most_objects) return;
      attribute.owner = owner;
      catalogue_.attributes.push_back(std::move(attribute));
    }
  }

  void skip(const Place& place, const std::string& why) {
    skip(fmt::format("{} ({})", place.path, why));
  }
  void skip(std::string what) {
    if (catalogue_.skipped.size() < most_objects) catalogue_.skipped.push_back(std::move(what));
  }

  bool is_matlab_;
  Catalogue catalogue_;
  std::set<haddr_t> visited_;
  std::size_t objects_ = 0;
};

}  // namespace

bool has_library() {
  return true;
}

Result<Catalogue> list_datasets(const Source& source, bool is_matlab) {
  const auto file = open_source(source);
  if (!file) return file.error();
  const Handle root(H5Gopen2(*file, "/", H5P_DEFAULT), H5Gclose);
  if (!root)
    return Error{Errc::corrupt,
                 fmt::format("is damaged: the HDF5 library says \"{}\"", failure_reason())};
  Lister lister(is_matlab);
  lister.visit_object(root, {});
  return lister.take();
}

}  // namespace proofmass::io::hdf5
