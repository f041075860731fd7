// The parts of a study's report that must hold whatever is in the files: escaping, classes of legends, words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "io/html/html.h"
#include "io/study/report_words.h"
#include "io/study/stepped_scale.h"
#include "io/xml/xml_text.h"

namespace skybake::io {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(Html, EscapesTextAndAttributes) {
    Html html;
    html.element("p", "<script>alert('1')</script> & \"x\"\x01", {{"class", "a\" onclick=\"b"}});
    EXPECT_EQ(
        html.str(),
        "<p class=\"a&quot; onclick=&quot;b\">&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; &quot;x&quot; "
        "</p>\n");
    Html table;
    table.table({"<b>"}, {{{"<i>"}}, {{"−1.5"}}, {{"12 345"}}, {{"2026-x"}}});
    EXPECT_THAT(table.str(), Not(HasSubstr("<b>")));
    EXPECT_THAT(table.str(), HasSubstr("<td class=\"words\">&lt;i&gt;</td>"));
    EXPECT_THAT(table.str(), HasSubstr("<td class=\"number\">−1.5</td>"));
    EXPECT_THAT(table.str(), HasSubstr("<td class=\"number\">12 345</td>"));
    EXPECT_THAT(table.str(), HasSubstr("<td class=\"words\">2026-x</td>"));
}

TEST(Html, DataUrisAreBase64) {
    // RFC 4648, §10.
    const std::string text = "foobar";
    const auto uri = [&](std::size_t n) {
        return data_uri("a/b", {reinterpret_cast<const std::uint8_t*>(text.data()), n});
    };
    EXPECT_EQ(uri(0), "data:a/b;base64,");
    EXPECT_EQ(uri(4), "data:a/b;base64,Zm9vYg==");
    EXPECT_EQ(uri(6), "data:a/b;base64,Zm9vYmFy");
}

TEST(SteppedScales, HaveTheThresholdsAmongTheirEdges) {
    for (const auto& [least, greatest, thresholds] : {std::tuple{0.0, 10.23, std::vector{2.0}},
                                                      {0.0, 10.23, std::vector{1.5, 3.0, 4.0}},
                                                      {3.2, 39.6, std::vector{27.0}},
                                                      {0.0, 0.4, std::vector{0.02}},
                                                      {5.0, 5.0, std::vector<double>{}},
                                                      {0.0, 1.0, std::vector{50.0}}}) {
        const SteppedScale scale = stepped_scale(least, greatest, thresholds);
        ASSERT_EQ(scale.edges.size(), scale.colours.size() + 1);
        ASSERT_EQ(scale.edges.size(), scale.is_marked.size());
        EXPECT_TRUE(std::is_sorted(scale.edges.begin(), scale.edges.end()));
        EXPECT_LE(scale.edges.front(), least);
        EXPECT_GE(scale.edges.back(), greatest);
        EXPECT_LE(scale.colours.size(), 13u);
        for (const double t : thresholds) {
            if (t > greatest) continue;
            EXPECT_THAT(scale.edges, Contains(testing::DoubleNear(t, 1e-9)));
            EXPECT_EQ(scale.class_of(t), scale.class_of(t + 1e-6));
            EXPECT_EQ(scale.class_of(t) - 1, scale.class_of(t - 1e-6));
        }
    }
}

TEST(SteppedScales, DifferencesHaveNoneInTheMiddle) {
    const SteppedScale scale = difference_scale(3.4, 1.0 / 60.0);
    ASSERT_EQ(scale.edges.size(), scale.colours.size() + 1);
    const std::size_t middle = scale.class_of(0.0);
    EXPECT_EQ(middle, scale.colours.size() / 2);
    EXPECT_EQ(scale.class_of(0.016), middle);
    EXPECT_EQ(scale.class_of(0.017), middle + 1);
    EXPECT_EQ(scale.class_of(-0.017), middle - 1);
    EXPECT_GT(scale.colours.front()[0], scale.colours.front()[2]);  // losses are brown
    EXPECT_LT(scale.colours.back()[0], scale.colours.back()[2]);    // gains are blue
}

TEST(Words, WriteNumbersAsTheLanguageDoes) {
    const Words english(Language::english), german(Language::german);
    EXPECT_EQ(english.number(-1.25, 1), "−1.2");
    EXPECT_EQ(german.number(1.5, 2), "1,50");
    EXPECT_EQ(english.number(-0.001, 2), "0.00");
    EXPECT_EQ(english.change(0.5, 1), "+0.5");
    EXPECT_EQ(english.change(0.001, 1), "0.0");
    EXPECT_EQ(english.number(std::nan(""), 1), "–");
    EXPECT_EQ(english.count(1234567), "1\u202f234\u202f567");
    EXPECT_EQ(german.day({3, 21}), "21. März");
}

}  // namespace
}  // namespace skybake::io
