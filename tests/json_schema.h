// Do our JSON files keep their schemas?
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace skybake {

/// Checks `value` against the part of JSON Schema that our schemas use; says where it does not fit.
inline void check_schema(const nlohmann::json& root, nlohmann::json schema, const nlohmann::json& value,
                         const std::string& where) {
    while (schema.contains("$ref")) schema = root["definitions"][schema["$ref"].get<std::string>().substr(14)];
    if (schema.contains("const")) {
        EXPECT_EQ(value, schema["const"]) << where;
    }
    if (schema.contains("enum")) {
        EXPECT_THAT(schema["enum"], ::testing::Contains(value)) << where;
    }
    if (schema.contains("oneOf")) return check_schema(root, schema["oneOf"][value.is_null() ? 0 : 1], value, where);
    const std::string type = schema.value("type", "");
    if (type == "null") {
        EXPECT_TRUE(value.is_null()) << where;
    }
    if (type == "string") {
        EXPECT_TRUE(value.is_string()) << where;
    }
    if (type == "integer") {
        EXPECT_TRUE(value.is_number_integer()) << where;
    }
    if (type == "number") {
        EXPECT_TRUE(value.is_number()) << where;
    }
    if (schema.contains("minimum")) {
        EXPECT_GE(value.get<double>(), schema["minimum"].get<double>()) << where;
    }
    if (schema.contains("exclusiveMinimum")) {
        EXPECT_GT(value.get<double>(), schema["exclusiveMinimum"].get<double>()) << where;
    }
    if (type == "array") {
        ASSERT_TRUE(value.is_array()) << where;
        EXPECT_GE(value.size(), schema.value("minItems", std::size_t{0})) << where;
        for (const nlohmann::json& item : value) check_schema(root, schema["items"], item, where + "[]");
    }
    if (type != "object") return;
    ASSERT_TRUE(value.is_object()) << where;
    for (const nlohmann::json& name : schema.value("required", nlohmann::json::array())) {
        EXPECT_TRUE(value.contains(name.get<std::string>())) << where << " lacks " << name;
    }
    for (const auto& [name, child] : value.items()) {
        if (schema.value("properties", nlohmann::json::object()).contains(name)) {
            check_schema(root, schema["properties"][name], child, where + "/" + name);
        } else {
            ASSERT_TRUE(schema["additionalProperties"].is_object())
                << where << " has " << name << ", which the schema does not know";
            check_schema(root, schema["additionalProperties"], child, where + "/" + name);
        }
    }
}

}  // namespace skybake
