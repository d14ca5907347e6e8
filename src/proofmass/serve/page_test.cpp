#include "proofmass/serve/page.hpp"

#include <gtest/gtest.h>

namespace proofmass::serve::page_test {
namespace {

TEST(ContentSecurityPolicy, NamesScriptsAndStylesByTheirHashes) {
  // printf 'alert(1)' | openssl dgst -sha256 -binary | base64
  const std::string policy =
      content_security_policy("<style>a{}</style><p></p><script type=\"module\">alert(1)</script>");
  EXPECT_NE(policy.find("script-src 'sha256-bhHHL3z2vDgxUt0W3dWQOrprscmda2Y5pLsLg4GF+pI=';"),
            std::string::npos);
  EXPECT_NE(policy.find("style-src 'sha256-"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_NE(content_security_policy("<p></p>").find("script-src 'none'"), std::string::npos);
}

TEST(Page, IsOneFileThatAsksNobody) {
  const std::string_view page = page_html();
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_NE(page.find("<script"), std::string_view::npos);
  for (const char* foreign :
       {" src=", "@import", "<link rel=\"stylesheet\"", " onclick=", " style="})
    EXPECT_EQ(page.substr(0, page.find("<script")).find(foreign), std::string_view::npos)
        << foreign;
}

}  // namespace
}  // namespace proofmass::serve::page_test
