#include "report/page.hpp"

#include "report/svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eigengrain::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Escaped, MarkupIsText) {
  EXPECT_EQ(escaped("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
}

TEST(Escaped, KeepsUtf8) {
  EXPECT_EQ(escaped("Δt ≤ 2/√λ 😀"), "Δt ≤ 2/√λ 😀");
}

TEST(Escaped, ReplacesWhatXmlCannotHold) {
  const std::string lost = "\xEF\xBF\xBD";
  EXPECT_EQ(escaped(std::string("a\0b", 3)), "a" + lost + "b");
  EXPECT_EQ(escaped("\x1B[31m"), lost + "[31m");
  EXPECT_EQ(escaped("caf\xE9"), "caf" + lost);             // Latin-1
  EXPECT_EQ(escaped("\xC0\xAF"), lost + lost);             // a long way to write "/"
  EXPECT_EQ(escaped("\xED\xA0\x80"), lost + lost + lost);  // a surrogate
  EXPECT_EQ(escaped("\xE2\x82"), lost + lost);             // cut short
}

TEST(TextWidth, CountsCharactersNotBytes) {
  EXPECT_DOUBLE_EQ(text_width("ΔΔ", 10), 14);
  EXPECT_LT(text_width("ill", 10), text_width("mmm", 10));
}

TEST(Page, EscapesAllThatItIsTold) {
  Page page("<t>", "<s>");
  page.section("<h>");
  page.subsection("<i>");
  page.paragraph("<q>");
  page.list({"<l>"});
  page.picture("<svg/>", "<c>");
  page.table({.columns = {{.name = "<n>"}}, .rows = {{{"<v>", Emphasis::bad}}}}, "<k>");
  const std::string html = page.finish();
  for (const std::string name : {"t", "s", "h", "i", "q", "l", "c", "n", "v", "k"})
    EXPECT_THAT(html, HasSubstr("&lt;" + name + "&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("<v>")));
  EXPECT_THAT(html, HasSubstr("<svg/>"));
}

TEST(Page, NumbersItsFigures) {
  Page page("t", "");
  page.picture("<svg/>", "first");
  page.picture("<svg/>", "");  // a key
  page.picture("<svg/>", "second");
  EXPECT_THAT(page.finish(), HasSubstr("Figure 1. first"));
  EXPECT_THAT(page.finish(), HasSubstr("Figure 2. second"));
}

TEST(Page, NeedsNothingBesideItself) {
  const std::string html = Page("t", "s").finish();
  for (const char* tag : {"<script", "<link", "<img", "@import", "url("})
    EXPECT_THAT(html, Not(HasSubstr(tag)));
}

}  // namespace
}  // namespace eigengrain::report
