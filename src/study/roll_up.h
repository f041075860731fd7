// From cells to façades, storeys, buildings, and the whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/rule.h"
#include "study/study.h"

namespace skybake {

enum class Level : std::uint8_t {
    receiver,  // a storey of a façade, a roof, a polygon, a point
    facade,    // all storeys of one façade
    storey,    // all façades of one storey of a building
    building,  // all receivers of a building
    kind       // all receivers of a kind
};
const char* name_of(Level level);

struct GroupColumn {
    double mean = 0.0;  // by area
    double least = 0.0;
    double greatest = 0.0;
};

struct GroupCriterion {
    double area_pass = 0.0;  // shares of the area of which it is asked, 0…1
    double area_borderline = 0.0;
    double area_fail = 0.0;
    std::optional<double> area_pass_before;  // with a former state, by the threshold alone
    double least_margin = 0.0;               // of the samples of which it is asked
    Verdict verdict = Verdict::none;
};

struct Group {
    Level level = Level::receiver;
    std::string id;  // the receiver's, "OBJECT/SURFACE", "BUILDING/STOREY", BUILDING, or the kind's name
    ReceiverKind kind = ReceiverKind::point;  // of its receivers (the first one's, for a building)
    std::string building_id;
    std::size_t samples = 0;
    double area_m2 = 0.0;
    std::vector<GroupColumn> columns;      // as Study::columns
    std::vector<GroupCriterion> criteria;  // as Rule::criteria
    Verdict verdict = Verdict::none;       // the worst of the required criteria
};

/// The groups of a level, in the order of their first sample. A group passes a criterion when the share of its area
/// that passes is at least the criterion's (or the criterion's share of what passed before), and is borderline when it
/// does so with the borderline cells. Free points weigh 1 each.
std::vector<Group> rolled_up(const Rule& rule, const Study& study, Level level);

/// Those of all levels: kinds, buildings, storeys, façades, receivers.
std::vector<Group> rolled_up(const Rule& rule, const Study& study);

}  // namespace skybake
