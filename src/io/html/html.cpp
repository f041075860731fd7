#include "io/html/html.h"

#include <openssl/evp.h>

#include <cctype>

#include "base/check.h"
#include "io/xml/xml_text.h"

namespace skybake::io {
namespace {

bool is_number(std::string_view text) {
    if (text.rfind("−", 0) == 0 || text == "–") return true;  // a minus, or a dash for nothing
    if (text.empty()) return false;
    const std::size_t first = text[0] == '+' ? 1 : 0;
    return first < text.size() && std::isdigit(static_cast<unsigned char>(text[first])) &&
           text.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ/_:") == std::string_view::npos;
}

}  // namespace

Html& Html::open(std::string_view tag, Attributes attributes) {
    out_ += '<';
    out_ += tag;
    for (const auto& [name, value] : attributes) {
        out_ += ' ';
        out_ += name;
        out_ += "=\"";
        out_ += xml_text(value);
        out_ += '"';
    }
    out_ += '>';
    open_.emplace_back(tag);
    return *this;
}

Html& Html::close(std::string_view tag) {
    SKYBAKE_CHECK(!open_.empty() && open_.back() == tag);
    open_.pop_back();
    out_ += "</";
    out_ += tag;
    out_ += ">\n";
    return *this;
}

Html& Html::text(std::string_view text) {
    out_ += xml_text(text);
    return *this;
}

Html& Html::element(std::string_view tag, std::string_view content, Attributes attributes) {
    return open(tag, attributes).text(content).close(tag);
}

Html& Html::markup(std::string_view markup) {
    out_ += markup;
    return *this;
}

Html& Html::table(const std::vector<std::string>& head, const std::vector<std::vector<Cell>>& rows) {
    open("table").open("thead").open("tr");
    for (const std::string& cell : head) element("th", cell);
    close("tr").close("thead").open("tbody");
    for (const std::vector<Cell>& row : rows) {
        open("tr");
        for (const Cell& cell : row)
            element("td", cell.text, {{"class", cell.style ? cell.style : is_number(cell.text) ? "number" : "words"}});
        close("tr");
    }
    return close("tbody").close("table");
}

const std::string& Html::str() const {
    SKYBAKE_CHECK(open_.empty());
    return out_;
}

std::string data_uri(std::string_view type, std::span<const std::uint8_t> bytes) {
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(), static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(length));
    return "data:" + std::string(type) + ";base64," + text;
}

}  // namespace skybake::io
