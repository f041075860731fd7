// A piece of an XML document as a tree, small beside its text.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/xml/xml_scan.h"

namespace skybake::io {

/// The names of elements and attributes that occur in a file, each once.
class XmlNames {
  public:
    struct Name {
        std::string space;
        std::string local;
    };
    std::uint32_t number_of(std::string_view space, std::string_view local);
    const Name& operator[](std::uint32_t number) const { return names_[number]; }

  private:
    std::deque<Name> names_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

class XmlTree;

/// An element of a tree: as light as a pointer, none when it is empty.
class XmlElement {
  public:
    XmlElement() = default;
    XmlElement(const XmlTree* tree, std::uint32_t node) : tree_(tree), node_(node) {}

    explicit operator bool() const { return tree_ != nullptr; }
    friend bool operator==(const XmlElement&, const XmlElement&) = default;

    std::string_view name() const;   // without prefix
    std::string_view space() const;  // the namespace's URI
    /// The text of an element without child elements, trimmed.
    std::string_view text() const;
    std::size_t line() const;
    /// The value of an attribute, whatever its namespace; empty without one.
    std::string_view attribute(std::string_view name) const;

    XmlElement first_child() const;
    XmlElement next() const;  // the next sibling
    /// The first child of that name.
    XmlElement child(std::string_view name) const;

    std::uint32_t node() const { return node_; }
    const XmlTree* tree() const { return tree_; }

    /// Calls `f` for each child element, in order.
    template <typename F>
    void for_each_child(F&& f) const {
        for (XmlElement e = first_child(); e; e = e.next()) f(e);
    }

  private:
    const XmlTree* tree_ = nullptr;
    std::uint32_t node_ = 0;
};

/// Grows while a document is scanned. Text between child elements is not kept. Throws InputError when one tree passes
/// 2 GB.
class XmlTree {
  public:
    explicit XmlTree(XmlNames& names) : names_(&names) {}

    void start(const XmlStart& element);
    void text(std::string_view piece);
    void end();

    /// True while elements are open.
    bool is_open() const { return !open_.empty(); }
    XmlElement root() const { return nodes_.empty() ? XmlElement() : XmlElement(this, 0); }
    std::size_t bytes() const { return text_.size() + nodes_.size() * sizeof(Node); }
    std::size_t node_count() const { return nodes_.size(); }

  private:
    friend class XmlElement;
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Node {
        std::uint32_t name = 0;
        std::uint32_t first_child = kNone;
        std::uint32_t next = kNone;
        std::uint32_t text_begin = 0;
        std::uint32_t text_end = 0;
        std::uint32_t attribute_begin = 0;
        std::uint32_t attribute_end = 0;
        std::uint32_t line = 0;
    };
    struct Attribute {
        std::uint32_t name = 0;
        std::uint32_t text_begin = 0;
        std::uint32_t text_end = 0;
    };
    struct Open {
        std::uint32_t node = 0;
        std::uint32_t last_child = kNone;
    };

    XmlNames* names_;
    std::vector<Node> nodes_;
    std::vector<Attribute> attributes_;
    std::string text_;
    std::string pending_;
    std::vector<Open> open_;
};

}  // namespace skybake::io
