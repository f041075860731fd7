#include "io/xml/xml_tree.h"

#include <fmt/format.h>

#include "base/error.h"

namespace skybake::io {
namespace {

constexpr std::size_t kLargestTree = 1u << 31;
constexpr std::string_view kBlank = " \t\r\n";

}  // namespace

std::uint32_t XmlNames::number_of(std::string_view space, std::string_view local) {
    std::string key;
    key.reserve(space.size() + local.size() + 1);
    key.append(local).append(1, '\x1f').append(space);
    const auto [entry, is_new] = numbers_.emplace(std::move(key), static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back({std::string(space), std::string(local)});
    return entry->second;
}

std::string_view XmlElement::name() const {
    return (*tree_->names_)[tree_->nodes_[node_].name].local;
}

std::string_view XmlElement::space() const {
    return (*tree_->names_)[tree_->nodes_[node_].name].space;
}

std::string_view XmlElement::text() const {
    const XmlTree::Node& node = tree_->nodes_[node_];
    return std::string_view(tree_->text_).substr(node.text_begin, node.text_end - node.text_begin);
}

std::size_t XmlElement::line() const {
    return tree_->nodes_[node_].line;
}

std::string_view XmlElement::attribute(std::string_view name) const {
    const XmlTree::Node& node = tree_->nodes_[node_];
    for (std::uint32_t i = node.attribute_begin; i < node.attribute_end; ++i) {
        const XmlTree::Attribute& a = tree_->attributes_[i];
        if ((*tree_->names_)[a.name].local == name)
            return std::string_view(tree_->text_).substr(a.text_begin, a.text_end - a.text_begin);
    }
    return {};
}

XmlElement XmlElement::first_child() const {
    const std::uint32_t child = tree_->nodes_[node_].first_child;
    return child == XmlTree::kNone ? XmlElement() : XmlElement(tree_, child);
}

XmlElement XmlElement::next() const {
    const std::uint32_t next = tree_->nodes_[node_].next;
    return next == XmlTree::kNone ? XmlElement() : XmlElement(tree_, next);
}

XmlElement XmlElement::child(std::string_view name) const {
    for (XmlElement e = first_child(); e; e = e.next()) {
        if (e.name() == name) return e;
    }
    return {};
}

void XmlTree::start(const XmlStart& element) {
    pending_.clear();
    Node node;
    node.name = names_->number_of(element.space, element.name);
    node.line = static_cast<std::uint32_t>(element.line);
    node.attribute_begin = static_cast<std::uint32_t>(attributes_.size());
    for (const XmlAttribute& attribute : element.attributes) {
        const auto begin = static_cast<std::uint32_t>(text_.size());
        text_ += attribute.value;
        attributes_.push_back(
            {names_->number_of(attribute.space, attribute.name), begin, static_cast<std::uint32_t>(text_.size())});
    }
    node.attribute_end = static_cast<std::uint32_t>(attributes_.size());
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    if (!open_.empty()) {
        Open& parent = open_.back();
        if (parent.last_child == kNone) {
            nodes_[parent.node].first_child = number;
        } else {
            nodes_[parent.last_child].next = number;
        }
        parent.last_child = number;
    }
    nodes_.push_back(node);
    open_.push_back({number, kNone});
    if (bytes() > kLargestTree) {
        throw InputError(
            fmt::format("line {}: one object holds more than 2 GB. Split it, a terrain for instance into "
                        "tiles.",
                        nodes_.front().line));
    }
}

void XmlTree::text(std::string_view piece) {
    if (open_.empty() || open_.back().last_child != kNone) return;
    if (pending_.size() + text_.size() + piece.size() > kLargestTree)
        throw InputError(fmt::format("line {}: one text holds more than 2 GB. Split the object.", nodes_.back().line));
    pending_ += piece;
}

void XmlTree::end() {
    Node& node = nodes_[open_.back().node];
    if (node.first_child == kNone) {
        const std::size_t begin = pending_.find_first_not_of(kBlank);
        if (begin != std::string::npos) {
            const std::size_t end = pending_.find_last_not_of(kBlank) + 1;
            node.text_begin = static_cast<std::uint32_t>(text_.size());
            text_.append(pending_, begin, end - begin);
            node.text_end = static_cast<std::uint32_t>(text_.size());
        }
    }
    pending_.clear();
    open_.pop_back();
}

}  // namespace skybake::io
