#include "study/study_rows.h"

#include <algorithm>

#include "base/hash_rng.h"

namespace skybake {

std::vector<PacketRange> sampled_packets(const ReceiverSet& receivers, std::size_t count) {
    const std::vector<PacketRange> packets = packet_ranges(receivers.samples);
    if (packets.size() <= count) return packets;
    std::vector<PacketRange> sampled;
    for (std::size_t i = 0; i < count; ++i) {
        // One of each equal part of the list.
        const double at = (static_cast<double>(i) + static_cast<double>(uniform_float(0, i, 0, 0))) /
                          static_cast<double>(count) * static_cast<double>(packets.size());
        sampled.push_back(packets[std::min(static_cast<std::size_t>(at), packets.size() - 1)]);
    }
    return sampled;
}

std::vector<StudyRow> rows_of(const Study& study, const std::vector<PacketRange>& packets) {
    std::vector<StudyRow> rows;
    for (const PacketRange& packet : packets) {
        for (std::uint32_t i = packet.begin; i < packet.end; ++i) {
            const Sample& sample = study.receivers.samples[i];
            StudyRow row{i, study.receivers.receivers[sample.receiver].id, sample.position, {}};
            for (const Column& column : study.columns) row.values.push_back(column.values[i]);
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

ReceiverSet only_packet(const ReceiverSet& receivers, const PacketRange& packet) {
    ReceiverSet part = receivers;
    part.samples.assign(receivers.samples.begin() + packet.begin, receivers.samples.begin() + packet.end);
    for (Receiver& receiver : part.receivers) {
        const auto within = [&](std::uint32_t i) { return std::clamp(i, packet.begin, packet.end) - packet.begin; };
        receiver.sample_begin = within(receiver.sample_begin);
        receiver.sample_end = within(receiver.sample_end);
    }
    return part;
}

}  // namespace skybake
