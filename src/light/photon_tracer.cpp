// Based on: H. W. Jensen, "Realistic image synthesis using photon mapping", 2001, chapter 5. Deviations: sun and sky
// are aimed at the scene's box; direct light is not stored (Reichinger, Maierhofer, Tobler 2006, §3.1).
#include "light/photon_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/hash_rng.h"
#include "light/sky_distribution.h"
#include "light/surfaces.h"

namespace skybake {

namespace {

constexpr std::uint64_t kPhotonsPerTask = 8192;

/// Points of [0, 1)⁴ that fill it evenly however many are taken: multiples of powers of 1/g, modulo 1, where g⁵ = g
/// + 1. Based on: M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018. In integers, so that far
/// indices lose nothing.
class DepartureSequence {
  public:
    DepartureSequence(std::uint64_t seed, std::uint64_t source) {
        constexpr double kG = 1.1673039782614187;
        double power = 1.0;
        for (std::size_t d = 0; d < step_.size(); ++d) {
            power /= kG;
            step_[d] = static_cast<std::uint64_t>(power * 0x1p64);
            shift_[d] = hash_combine(hash_combine(seed, source), d);
        }
    }
    float at(std::uint64_t index, std::size_t dimension) const {
        return static_cast<float>((shift_[dimension] + index * step_[dimension]) >> 40) * 0x1p-24f;
    }

  private:
    std::array<std::uint64_t, 4> step_{}, shift_{};
};

/// A face of the scene's box that light enters through: corner and edges, and the normal that points out.
struct BoxFace {
    Vec3f corner, u, v, outward;
    double area() const { return static_cast<double>(glm::length(u)) * static_cast<double>(glm::length(v)); }
};

std::vector<BoxFace> faces_of(const Box3f& box) {
    const Vec3f size = box.hi - box.lo;
    const Vec3f x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    return {{{box.lo.x, box.lo.y, box.hi.z}, x, y, {0, 0, 1}},
            {box.lo, x, z, {0, -1, 0}},
            {{box.lo.x, box.hi.y, box.lo.z}, x, z, {0, 1, 0}},
            {box.lo, y, z, {-1, 0, 0}},
            {{box.hi.x, box.lo.y, box.lo.z}, y, z, {1, 0, 0}}};
}

struct Departure {
    Vec3f origin, direction;
    Rgb flux;  // lm
};

/// A source of photons: the sun or the sky through one face, or a lamp.
class Emitter {
  public:
    enum class Kind { sun, sky, lamp };

    Emitter(Kind kind, double flux, const BoxFace* face, const Lamp* lamp, std::optional<SkyDistribution> sky)
        : flux_(flux), kind_(kind), face_(face), lamp_(lamp), sky_(std::move(sky)) {}

    double flux() const { return flux_; }  // lm

    /// Photon `index` of `count`; none when its direction carries nothing.
    std::optional<Departure> depart(const LightSources& sources, const DepartureSequence& sequence, std::uint64_t index,
                                    std::uint64_t count) const {
        const float a = sequence.at(index, 0), b = sequence.at(index, 1);
        const float c = sequence.at(index, 2), d = sequence.at(index, 3);
        const double n = static_cast<double>(count);
        if (kind_ == Kind::lamp) return from_lamp(a, b, n);
        Departure departure;
        departure.origin = face_->corner + a * face_->u + b * face_->v;
        double measure = face_->area() / n;
        if (kind_ == Kind::sun) {
            const Vec3f to_sun = sample_sun(sources.daylight.sun, c, d);
            measure *= static_cast<double>(glm::dot(to_sun, face_->outward));
            departure.direction = -to_sun;
            departure.flux = sources.daylight.sun.normal_illuminance;
        } else {
            const SkyDistribution::Sample sample = sky_->sample(c, d);
            measure *= static_cast<double>(glm::dot(sample.direction, face_->outward) / sample.pdf_solid_angle);
            departure.direction = -sample.direction;
            departure.flux = sky_luminance(sources.daylight.sky, sample.direction);
        }
        departure.flux *= static_cast<float>(measure);
        if (!(luminance(departure.flux) > 0.0f)) return std::nullopt;
        return departure;
    }

  private:
    std::optional<Departure> from_lamp(float a, float b, double count) const {
        // Evenly over the cone, or the sphere.
        const double lowest =
            lamp_->type == Lamp::Type::point ? -1.0 : std::cos(static_cast<double>(lamp_->cone_half_angle_rad));
        const float z = static_cast<float>(lowest + (1.0 - lowest) * static_cast<double>(a));
        const float r = std::sqrt(std::max(0.0f, 1.0f - z * z)), turn = static_cast<float>(2.0 * kPi) * b;
        const TangentFrame frame = tangent_frame(lamp_->axis);
        const Vec3f direction =
            glm::normalize(r * std::cos(turn) * frame.u + r * std::sin(turn) * frame.v + z * lamp_->axis);
        const double solid_angle = 2.0 * kPi * (1.0 - lowest);
        const Rgb flux =
            lamp_->intensity * (intensity_share(*lamp_, direction) * static_cast<float>(solid_angle / count));
        if (!(luminance(flux) > 0.0f)) return std::nullopt;
        return Departure{lamp_->position, direction, flux};
    }

    double flux_;
    Kind kind_;
    const BoxFace* face_;
    const Lamp* lamp_;
    std::optional<SkyDistribution> sky_;  // for the cosine about the face's normal
};

class PhotonTracer {
  public:
    PhotonTracer(const LightSources& sources, const Scene& scene, const RayScene& rays, const PhotonOptions& options)
        : sources_(sources), scene_(scene), rays_(rays), options_(options) {
        Box3f box = scene.bounds;
        // A little larger: surfaces that lie on the box itself are met too.
        const float margin = std::max(0.01f, 4.0f * rays.surface_offset());
        box.lo -= margin;
        box.hi += margin;
        faces_ = faces_of(box);
        const SunBeam& sun = sources.daylight.sun;
        for (const BoxFace& face : faces_) {
            const double cosine = static_cast<double>(glm::dot(sun.direction, face.outward));
            // Half the disc may be below the face's plane; the cut is of no account next to what comes in elsewhere.
            if (has_beam(sun) && cosine > static_cast<double>(sun.angular_radius_rad)) {
                emitters_.emplace_back(Emitter::Kind::sun,
                                       face.area() * cosine * static_cast<double>(luminance(sun.normal_illuminance)),
                                       &face, nullptr, std::nullopt);
            }
        }
        for (const BoxFace& face : faces_) {
            SkyDistribution sky(sources.daylight.sky, face.outward);
            const double flux = face.area() * sky.total();
            if (flux > 0.0) emitters_.emplace_back(Emitter::Kind::sky, flux, &face, nullptr, std::move(sky));
        }
        for (const Lamp& lamp : sources.lamps) {
            const double flux = effective_solid_angle(lamp) * static_cast<double>(luminance(lamp.intensity));
            if (flux > 0.0) emitters_.emplace_back(Emitter::Kind::lamp, flux, nullptr, &lamp, std::nullopt);
        }
        double total = 0.0, before = 0.0;
        for (const Emitter& emitter : emitters_) total += emitter.flux();
        first_.push_back(0);
        const double n = static_cast<double>(options.count);
        for (const Emitter& emitter : emitters_) {
            const double after = before + emitter.flux();
            const std::uint64_t share =
                static_cast<std::uint64_t>(std::llround(after / total * n) - std::llround(before / total * n));
            first_.push_back(first_.back() + std::max<std::uint64_t>(share, 1));
            sequences_.emplace_back(options.seed, sequences_.size());
            before = after;
        }
    }

    std::uint64_t count() const { return first_.back(); }

    void trace(std::uint64_t photon, std::vector<Photon>& stored, PhotonLedger& ledger) const {
        const std::size_t e =
            static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), photon) - first_.begin()) - 1;
        const auto departure =
            emitters_[e].depart(sources_, sequences_[e], photon - first_[e], first_[e + 1] - first_[e]);
        if (!departure) return;
        Rgb flux = departure->flux;
        const double lumen = static_cast<double>(luminance(flux));
        ledger.emitted += lumen;
        ++ledger.photons;
        RandomSequence random(options_.seed, photon, 0);
        Vec3f origin = departure->origin, direction = departure->direction;
        for (int reflections = 0;; ++reflections) {
            const auto hit = rays_.first_hit(origin, direction);
            ++ledger.rays;
            if (!hit) {
                ledger.escaped += lumen;
                return;
            }
            const SurfacePoint surface = surface_point(scene_, *hit);
            if (reflections > 0) stored.emplace_back(surface.position, surface.normal, flux);
            if (reflections == options_.bounces) {
                ledger.at_limit += lumen;
                return;
            }
            const Rgb reflected = flux * surface.albedo;
            const float survival = luminance(reflected) / luminance(flux);
            if (!(random.next() < survival)) {
                ledger.absorbed += lumen;
                return;
            }
            flux = reflected / survival;
            const float u = random.next(), v = random.next();
            direction = square_to_cosine_hemisphere(surface.normal, u, v);
            origin = surface.position + rays_.surface_offset() * surface.normal;
        }
    }

  private:
    const LightSources& sources_;
    const Scene& scene_;
    const RayScene& rays_;
    const PhotonOptions& options_;
    std::vector<BoxFace> faces_;
    std::vector<Emitter> emitters_;
    std::vector<DepartureSequence> sequences_;  // [emitter]
    std::vector<std::uint64_t> first_;          // [emitter]: its first photon; one more than there are emitters
};

}  // namespace

PhotonRun trace_photons(const LightSources& sources, const Scene& scene, const RayScene& rays,
                        const PhotonOptions& options, Progress& progress) {
    PhotonRun run;
    if (scene.triangles.empty()) return run;
    const PhotonTracer tracer(sources, scene, rays, options);
    const std::size_t tasks = static_cast<std::size_t>((tracer.count() + kPhotonsPerTask - 1) / kPhotonsPerTask);
    std::vector<PhotonRun> parts(tasks);
    progress.begin("photons", tracer.count());
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t t) {
        if (progress.stop_requested()) throw Interrupted();
        const std::uint64_t begin = t * kPhotonsPerTask, end = std::min(begin + kPhotonsPerTask, tracer.count());
        for (std::uint64_t photon = begin; photon < end; ++photon)
            tracer.trace(photon, parts[t].photons, parts[t].ledger);
        progress.advance(end - begin);
    });
    std::size_t stored = 0;
    for (const PhotonRun& part : parts) stored += part.photons.size();
    run.photons.reserve(stored);
    for (PhotonRun& part : parts) {
        run.photons.insert(run.photons.end(), part.photons.begin(), part.photons.end());
        part.photons = {};
        run.ledger.emitted += part.ledger.emitted;
        run.ledger.absorbed += part.ledger.absorbed;
        run.ledger.escaped += part.ledger.escaped;
        run.ledger.at_limit += part.ledger.at_limit;
        run.ledger.photons += part.ledger.photons;
        run.ledger.rays += part.ledger.rays;
    }
    return run;
}

}  // namespace skybake
