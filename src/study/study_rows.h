// A few rows of a study, by which another run can check it.
#pragma once

#include <string>
#include <vector>

#include "study/packets.h"
#include "study/study.h"

namespace skybake {

/// A row of the table of cells.
struct StudyRow {
    std::size_t sample = 0;
    std::string receiver;
    Vec3d position{0.0};
    std::vector<float> values;  // as Study::columns
};

/// Up to `count` packets of the set, spread over it, in ascending order: always the same of the same set. Whole
/// packets, as cells that are traced together find each other's short moments of sun (sun_intervals.h).
std::vector<PacketRange> sampled_packets(const ReceiverSet& receivers, std::size_t count);

/// The rows of the samples of packets, of a study of all.
std::vector<StudyRow> rows_of(const Study& study, const std::vector<PacketRange>& packets);

/// The set with nothing but one packet of it; all receivers stay, most of them without samples.
ReceiverSet only_packet(const ReceiverSet& receivers, const PacketRange& packet);

}  // namespace skybake
