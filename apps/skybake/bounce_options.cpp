#include "bounce_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/nearest_word.h"

namespace skybake::cli {

namespace {

constexpr const char* kGroup = "Reflected light";

}  // namespace

void add_bounce_options(CLI::App* verb, BounceOptions& options) {
    verb->add_option("--indirect", options.indirect, "none, photons, or reference (unbiased paths, slow)")
        ->group(kGroup)
        ->type_name("METHOD")
        ->capture_default_str();
    verb->add_option("--bounces", options.bounces, "reflections at most")
        ->group(kGroup)
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb->add_option("--photons", options.photons,
                     "photons that sun, sky and lamps send out, for each instant; default: 40 a m2 of surface, at "
                     "least 1 million")
        ->group(kGroup)
        ->type_name("N")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    verb->add_option("--nearest", options.nearest, "photons that count at a point")
        ->group(kGroup)
        ->type_name("N")
        ->check(CLI::Range(10, 100000))
        ->capture_default_str();
    verb->add_option("--area", options.area,
                     "of these photons: their convex hull or bounding octagon, extended, or the circle about the point")
        ->group(kGroup)
        ->check(CLI::IsMember(std::vector<std::string>(kPhotonAreaNames.begin(), kPhotonAreaNames.end())))
        ->capture_default_str();
    verb->add_option("--feelers", options.feelers,
                     "short rays along the surface that keep light from leaking through walls")
        ->group(kGroup)
        ->check(CLI::IsMember({0, 4, 8}))
        ->capture_default_str();
    verb->add_option("--paths", options.paths, "paths per point or texel of --indirect reference")
        ->group(kGroup)
        ->type_name("N")
        ->check(CLI::Range(2, 1 << 30))
        ->capture_default_str();
}

Indirect indirect_of(const BounceOptions& options) {
    if (options.indirect == "none") return Indirect::none;
    if (options.indirect == "photons") return Indirect::photons;
    if (options.indirect == "reference") return Indirect::reference;
    const std::vector<std::string> known = {"none", "photons", "reference"};
    throw InputError(fmt::format("--indirect '{}' is unknown; did you mean '{}'?", options.indirect,
                                 nearest_word(options.indirect, known)));
}

std::vector<std::pair<std::string, std::string>> settings_of(const BounceOptions& options) {
    std::vector<std::pair<std::string, std::string>> settings{{"indirect", options.indirect}};
    if (options.indirect == "none") return settings;
    settings.emplace_back("bounces", std::to_string(options.bounces));
    if (options.indirect == "reference") {
        settings.emplace_back("paths", std::to_string(options.paths));
        return settings;
    }
    settings.insert(settings.end(), {{"photons", options.photons ? std::to_string(*options.photons) : "20 per m2"},
                                     {"nearest", std::to_string(options.nearest)},
                                     {"area", options.area},
                                     {"feelers", std::to_string(options.feelers)}});
    return settings;
}

BouncePhotons photons_of(const BounceOptions& options, std::uint64_t seed) {
    const auto area = std::find(kPhotonAreaNames.begin(), kPhotonAreaNames.end(), options.area);
    return {{options.photons, options.bounces, seed},
            {options.nearest, static_cast<PhotonArea>(area - kPhotonAreaNames.begin()), options.feelers}};
}

PathOptions path_options_of(const BounceOptions& options, std::uint64_t seed) {
    return {options.paths, options.bounces, seed};
}

}  // namespace skybake::cli
