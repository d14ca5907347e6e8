# Writes to OUT a source that holds FILE, for proofmass::serve::page_html().
file(READ ${FILE} bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
string(REGEX REPLACE "(('[^']+',){24})" "\\1\n" bytes "${bytes}")
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include "proofmass/serve/page.hpp"

namespace proofmass::serve {
namespace {

constexpr char page[] = {
@bytes@};

}  // namespace

std::string_view page_html() {
  return {page, sizeof page};
}

}  // namespace proofmass::serve
]])
