#include "proofmass/report/page/page.hpp"

#include <gtest/gtest.h>

namespace proofmass::report::page_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Page page_with_parts() {
  Section part{.heading = "A <part>",
               .id = "part-1",
               .gist = "2 of 3",
               .sides = {{"One", "first & last"}, {"Other", "second"}},
               .tables = {{.caption = "", .head = {}, .rows = {{"a", "b"}}, .stacks = true}},
               .figures = {Figure{.title = "Curve", .description = "It rises.", .x = {}, .y = {}}}};
  Page page{.verb = "v", .title = "t", .inputs = {}, .conclusion = "c"};
  page.sections = {{.heading = "Chapter", .id = "chapter", .parts = {std::move(part)}},
                   {.heading = "Remarks", .paragraphs = {"None."}}};
  return page;
}

TEST(Page, SetsPartsUnderSmallerHeadingsBelowTheirSection) {
  const std::string text = html(page_with_parts());
  const auto chapter = text.find("<section id=\"chapter\">\n<h2>Chapter</h2>");
  const auto part = text.find("<section class=\"part\" id=\"part-1\">\n<h3>A &lt;part&gt;</h3>");
  ASSERT_NE(chapter, std::string::npos);
  ASSERT_NE(part, std::string::npos);
  EXPECT_LT(chapter, part);
  EXPECT_LT(part, text.find("<h2>Remarks</h2>"));
}

TEST(Page, SetsShortTextsBesideEachOther) {
  EXPECT_TRUE(has(html(page_with_parts()),
                  "<div><b>One</b><p>first &amp; last</p></div>\n<div><b>Other</b>"));
}

TEST(Page, ListsExactlyThePartsWithAnIdInItsContents) {
  Page page = page_with_parts();
  EXPECT_FALSE(has(html(page), "<nav"));
  page.contents = true;
  const std::string text = html(page);
  EXPECT_TRUE(has(text, "<a href=\"#chapter\">Chapter</a>"));
  EXPECT_TRUE(has(text, "<li><a href=\"#part-1\">A &lt;part&gt;</a> <span>2 of 3</span></li>"));
  EXPECT_FALSE(has(text, ">Remarks</a>"));
}

TEST(Page, NumbersItsFiguresUnlessAskedNotTo) {
  Page page = page_with_parts();
  EXPECT_TRUE(has(html(page), "<b>Figure 1. Curve</b>"));
  page.numbered = false;
  EXPECT_TRUE(has(html(page), "<b>Curve</b>"));
}

TEST(Page, StacksTheTablesThatAskForIt) {
  Page page = page_with_parts();
  EXPECT_TRUE(has(html(page), "<table class=\"stacks\">"));
  page.sections.front().parts.front().tables.front().stacks = false;
  EXPECT_FALSE(has(html(page), "<table class=\"stacks\">"));
}

}  // namespace
}  // namespace proofmass::report::page_test
