#include "io/xml/xml_scan.h"

#include <expat.h>
#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <memory>
#include <vector>

#include "base/error.h"

namespace skybake::io {
namespace {

constexpr std::size_t kPieceBytes = 1u << 18;
/// Real city files nest about 30 deep.
constexpr std::size_t kDeepest = 256;
/// A tag is parsed anew with each piece until it is whole; this bounds the time that takes.
constexpr std::uint64_t kLongestTag = 16u << 20;
constexpr char kSeparator = '\x1f';

struct ParserDeleter {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};
using ParserPtr = std::unique_ptr<XML_ParserStruct, ParserDeleter>;

struct Scan {
    XML_Parser parser = nullptr;
    XmlVisitor* visitor = nullptr;
    std::size_t depth = 0;
    std::vector<XmlAttribute> attributes;
    std::string fault;          // ours, where expat sees none
    std::exception_ptr thrown;  // by the visitor: must not fly through C

    template <typename F>
    void guarded(F&& f) {
        if (thrown || !fault.empty()) return;
        try {
            f();
        } catch (...) {
            thrown = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }
    void fail(std::string what) {
        fault = std::move(what);
        XML_StopParser(parser, XML_FALSE);
    }
};

/// "URI<separator>local", or the local name alone.
std::pair<std::string_view, std::string_view> split(const char* name) {
    const std::string_view whole(name);
    const std::size_t at = whole.find(kSeparator);
    if (at == std::string_view::npos) return {{}, whole};
    return {whole.substr(0, at), whole.substr(at + 1)};
}

void XMLCALL on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
    Scan& scan = *static_cast<Scan*>(data);
    scan.guarded([&] {
        if (++scan.depth > kDeepest) {
            scan.fail(fmt::format("is nested more than {} elements deep", kDeepest));
            return;
        }
        scan.attributes.clear();
        for (std::size_t i = 0; attributes[i]; i += 2) {
            const auto [space, local] = split(attributes[i]);
            scan.attributes.push_back({space, local, attributes[i + 1]});
        }
        const auto [space, local] = split(name);
        scan.visitor->start({space, local, scan.attributes, XML_GetCurrentLineNumber(scan.parser)});
        if (!scan.visitor->wants_more()) XML_StopParser(scan.parser, XML_FALSE);
    });
}

void XMLCALL on_end(void* data, const XML_Char*) {
    Scan& scan = *static_cast<Scan*>(data);
    scan.guarded([&] {
        --scan.depth;
        scan.visitor->end();
        if (!scan.visitor->wants_more()) XML_StopParser(scan.parser, XML_FALSE);
    });
}

void XMLCALL on_text(void* data, const XML_Char* text, int length) {
    Scan& scan = *static_cast<Scan*>(data);
    scan.guarded([&] { scan.visitor->text({text, static_cast<std::size_t>(length)}); });
}

void XMLCALL on_entity(void* data, const XML_Char* name, int, const XML_Char*, int, const XML_Char*, const XML_Char*,
                       const XML_Char*, const XML_Char*) {
    Scan& scan = *static_cast<Scan*>(data);
    if (scan.fault.empty()) {
        scan.fail(fmt::format("declares an entity ('{}'), which is refused: a city file needs none",
                              std::string_view(name).substr(0, 40)));
    }
}

}  // namespace

void scan_xml(const std::filesystem::path& path, XmlVisitor& visitor, const Progress& progress,
              const std::function<void(std::string_view)>& bytes) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(fmt::format("{}: cannot be opened for reading.", path.string()));
    const ParserPtr owner(XML_ParserCreateNS(nullptr, kSeparator));
    if (!owner) throw std::bad_alloc();
    XML_Parser parser = owner.get();
    Scan scan;
    scan.parser = parser;
    scan.visitor = &visitor;
    XML_SetUserData(parser, &scan);
    XML_SetElementHandler(parser, on_start, on_end);
    XML_SetCharacterDataHandler(parser, on_text);
    XML_SetEntityDeclHandler(parser, on_entity);
    XML_SetParamEntityParsing(parser, XML_PARAM_ENTITY_PARSING_NEVER);

    std::uint64_t fed = 0;
    for (bool is_last = false; !is_last;) {
        if (progress.stop_requested()) throw Interrupted();
        void* buffer = XML_GetBuffer(parser, static_cast<int>(kPieceBytes));
        if (!buffer) throw std::bad_alloc();
        in.read(static_cast<char*>(buffer), static_cast<std::streamsize>(kPieceBytes));
        const auto count = static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0));
        is_last = count < kPieceBytes;
        fed += count;
        if (bytes) bytes({static_cast<const char*>(buffer), count});
        const XML_Status status = XML_ParseBuffer(parser, static_cast<int>(count), is_last);
        if (scan.thrown) std::rethrow_exception(scan.thrown);
        if (status != XML_STATUS_OK && scan.fault.empty()) {
            if (XML_GetErrorCode(parser) == XML_ERROR_ABORTED) return;  // the visitor has what it wants
            scan.fault = fmt::format("is not well-formed XML ({})", XML_ErrorString(XML_GetErrorCode(parser)));
        }
        if (scan.fault.empty() && !is_last) {
            const XML_Index at = XML_GetCurrentByteIndex(parser);
            if (at >= 0 && fed - static_cast<std::uint64_t>(at) > kLongestTag)
                scan.fault = "holds a tag of more than 16 MB";
        }
        if (!scan.fault.empty()) {
            throw InputError(fmt::format("{}:{}: {}. Export the file again, or complete the download.", path.string(),
                                         XML_GetCurrentLineNumber(parser), scan.fault));
        }
    }
}

}  // namespace skybake::io
