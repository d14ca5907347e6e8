#pragma once

#include <hdf5.h>
#include <string>
#include <vector>

#include "proofmass/io/hdf5/catalogue.hpp"

namespace proofmass::io::hdf5 {

[[nodiscard]] bool has_attribute(hid_t object, const char* name);

/// A text attribute; empty if there is none.
[[nodiscard]] std::string text_attribute(hid_t object, const char* name);

/// The attributes of an object that are texts, up to 64 each, or a single number.
[[nodiscard]] std::vector<Attribute> attributes_of(hid_t object);

}  // namespace proofmass::io::hdf5
