#include "report/page_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tessera {
namespace {

TEST(PageText, EscapesHtml) {
    EXPECT_EQ(EscapeHtml("<a href=\"x\">'&'</a>"),
              "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
    EXPECT_EQ(EscapeHtml("Küche"), "Küche");
    EXPECT_EQ(EscapeHtml("a\nb\xff"), "a\\x0ab\\xff");
}

TEST(PageText, JsonCannotEndItsElement) {
    const nlohmann::json json = {{"name", "</script><!--<script>&amp;"}};
    const std::string escaped = EscapeScriptJson(json.dump());
    EXPECT_EQ(escaped.find_first_of("<>&"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(escaped), json);
}

TEST(PageText, Base64) {
    const auto of = [](std::string_view text) {
        return Base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    // RFC 4648, section 10.
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(of("\xfb\xff\xbf"), "+/+/");
}

TEST(PageText, TemplateValuesAreNotSearchedAgain) {
    EXPECT_EQ(FillTemplate("a {{x}} b {{y}}{{x}} {", {{"x", "{{y}}"}, {"y", "2"}}),
              "a {{y}} b 2{{y}} {");
}

}  // namespace
}  // namespace tessera
