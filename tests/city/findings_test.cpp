// The table of findings is whole, in order, and told of in the docs.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "city/finding_codes.h"

namespace skybake {
namespace {

TEST(FindingCodes, AreUniqueOrderedAndWhole) {
    std::string_view previous;
    for (const FindingCode& code : kFindingCodes) {
        EXPECT_LT(previous, code.code);
        EXPECT_EQ(code.code.size(), 5u);
        EXPECT_EQ(code.code.substr(0, 2), "SB");
        EXPECT_FALSE(code.title.empty());
        ASSERT_FALSE(code.remedy.empty());
        EXPECT_EQ(code.remedy.back(), '.') << code.code;
        previous = code.code;
    }
    EXPECT_EQ(find_code("SB999"), nullptr);
    EXPECT_EQ(make_finding("SB203", "w", "x.").severity, Severity::warning);
}

TEST(FindingCodes, EachHasItsSectionInTheDocs) {
    std::ifstream in(SKYBAKE_DOCS_FOLDER "/findings.md");
    ASSERT_TRUE(in);
    std::stringstream text;
    text << in.rdbuf();
    for (const FindingCode& code : kFindingCodes) {
        EXPECT_NE(text.str().find("\n### " + std::string(code.code) + " "), std::string::npos) << code.code;
        EXPECT_NE(text.str().find(code.remedy), std::string::npos)
            << code.code << ": the remedy in the docs is not the program's";
    }
}

}  // namespace
}  // namespace skybake
