// XML files of any size, element by element. The only user of expat.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/progress.h"

namespace skybake::io {

struct XmlAttribute {
    std::string_view space;  // the namespace's URI; empty without one
    std::string_view name;
    std::string_view value;
};

struct XmlStart {
    std::string_view space;  // the namespace's URI
    std::string_view name;   // without prefix
    std::span<const XmlAttribute> attributes;
    std::size_t line = 0;
};

/// Receives what a document holds, in order. Views live for the call.
class XmlVisitor {
  public:
    virtual ~XmlVisitor() = default;
    virtual void start(const XmlStart& element) = 0;
    /// A piece of text; one text may come in many pieces.
    virtual void text(std::string_view piece) = 0;
    virtual void end() = 0;
    /// False to leave the rest of the file unread.
    virtual bool wants_more() const { return true; }
};

/// Reads the file once. `bytes` is called with each piece of it. Nothing but the file is ever opened, and entities of
/// its own are refused. Throws InputError with file and line when it is not well-formed, declares entities, is nested
/// more than 256 deep or holds a tag of more than 16 MB; Interrupted when `progress` wants to stop. What the visitor
/// throws comes out again.
void scan_xml(const std::filesystem::path& path, XmlVisitor& visitor, const Progress& progress,
              const std::function<void(std::string_view bytes)>& bytes = {});

}  // namespace skybake::io
