// A study whose receivers are the texels of a bake.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "api/prepared_study.h"

namespace skybake {

struct TexelStudy {
    std::vector<std::string> layers;  // ids, as written
    std::uint64_t texels = 0;         // that were computed
    std::uint64_t rays = 0;
    FindingLog findings;
};

/// Computes the rule's metrics at all texels of the bake but the buried ones, and adds them to it as layers
/// (io/manifest/write_layers.h): "RULE_METRIC_DATE", and with a former state "RULE_METRIC_DATE_change", after less
/// before. The atlas is made again from those files of the request that the bake was made from: the city with the plan,
/// the city, or the former city. Without value are texels of objects that do not stand any more and, for changes, of
/// those that did not stand before. Page by page: memory is that of one page's texels and of the layers. Throws
/// InputError as prepare_study does, and where city and bake do not match.
TexelStudy study_texels(const StudyRequest& request, const std::filesystem::path& bake_folder, Progress& progress);

}  // namespace skybake
