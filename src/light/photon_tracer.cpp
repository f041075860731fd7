// Based on: H. W. Jensen, "Realistic image synthesis using photon mapping", 2001, chapter 5. Deviations: sun and sky
// are aimed at the scene's box; direct light is not stored (Reichinger, Maierhofer, Tobler 2006, §3.1).
#include "light/photon_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/hash_rng.h"
#include "light/cell_distribution.h"
#include "light/flight.h"
#include "light/sky_distribution.h"
#include "light/surfaces.h"

namespace skybake {

namespace {

constexpr std::uint64_t kPhotonsPerTask = 8192;

// The pilot run that finds where on the box's faces photons are worth sending: a share of all, but enough to say
// something of each cell.
constexpr int kAimCells = 32;  // a side of each face
constexpr std::uint64_t kPilotShare = 20;
constexpr std::uint64_t kMinPilot = 40'000;
// What a cell's photons are taken to be worth at least, of the mean: none is given up.
constexpr double kAimFloor = 0.02;

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
    Rgb flux;              // lm
    std::size_t cell = 0;  // of the face it left through
};

/// A source of photons: the sun or the sky through one face, or a lamp.
class Emitter {
  public:
    enum class Kind { sun, sky, lamp };

    Emitter(Kind kind, double flux, const BoxFace* face, const Lamp* lamp, std::optional<SkyDistribution> sky)
        : flux_(flux), kind_(kind), face_(face), lamp_(lamp), sky_(std::move(sky)) {}

    bool has_face() const { return face_ != nullptr; }
    /// `weight` [row × kAimCells + column]: how dense photons depart from the cells of the face, positive.
    void set_aim(std::vector<double> weight) { aim_ = CellDistribution(std::move(weight), kAimCells); }
    /// What its share of the photons goes by: its flux (lm) times how much its photons are worth.
    double worth() const { return flux_ * mean_weight(); }

    /// Photon `index` of `count`; none when its direction carries nothing.
    std::optional<Departure> depart(const LightSources& sources, const DepartureSequence& sequence, std::uint64_t index,
                                    std::uint64_t count) const {
        const float a = sequence.at(index, 0), b = sequence.at(index, 1);
        const float c = sequence.at(index, 2), d = sequence.at(index, 3);
        const double n = static_cast<double>(count);
        if (kind_ == Kind::lamp) return from_lamp(a, b, n);
        Departure departure;
        const CellDistribution::Place place = aim_.sample(a, b);
        departure.cell = place.cell;
        departure.origin = face_->corner + static_cast<float>(place.column / kAimCells) * face_->u +
                           static_cast<float>(place.row / kAimCells) * face_->v;
        double measure = face_->area() / (n * (aim_.mass(place.cell) / mean_weight()));  // area a photon stands for
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
    double mean_weight() const { return aim_.total() / (kAimCells * kAimCells); }

    std::optional<Departure> from_lamp(float a, float b, double count) const {
        const LampSample sample = sample_lamp(*lamp_, a, b);
        const Vec3f& direction = sample.direction;
        const Rgb flux = lamp_->intensity * static_cast<float>(static_cast<double>(intensity_share(*lamp_, direction)) /
                                                               (sample.pdf_solid_angle * count));
        if (!(luminance(flux) > 0.0f)) return std::nullopt;
        return Departure{lamp_->position, direction, flux, 0};
    }

    double flux_;
    Kind kind_;
    const BoxFace* face_;
    const Lamp* lamp_;
    std::optional<SkyDistribution> sky_;  // for the cosine about the face's normal
    CellDistribution aim_{std::vector<double>(kAimCells * kAimCells, 1.0), kAimCells};  // of a lamp: even
};

class PhotonTracer {
  public:
    PhotonTracer(const LightSources& sources, const Scene& scene, const RayScene& rays, const PhotonOptions& options)
        : sources_(sources),
          scene_(scene),
          rays_(rays),
          options_(options),
          wanted_(options.count.value_or(default_photon_count(scene))) {
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
        for (std::size_t e = 0; e < emitters_.size(); ++e) sequences_.emplace_back(options.seed, e);
        share_out(std::max(wanted_ / kPilotShare, kMinPilot));
    }

    std::uint64_t count() const { return first_.back(); }

    /// Sends a small run ahead, and each face's photons henceforth to where that run's came to rest. The variance of a
    /// sum over cells is least when each gets photons by the root of the mean square of what one of them gives (J.
    /// Neyman 1934). Returns the number of rays.
    std::uint64_t aim() {
        constexpr std::size_t kCells = kAimCells * kAimCells;
        std::vector<std::atomic<std::uint64_t>> sent(emitters_.size() * kCells), squares(sent.size());
        std::atomic<std::uint64_t> rays{0};
        tbb::parallel_for(std::uint64_t{0}, (count() + kPhotonsPerTask - 1) / kPhotonsPerTask, [&](std::uint64_t t) {
            std::vector<Photon> stored;
            PhotonLedger ledger;
            const std::uint64_t end = std::min((t + 1) * kPhotonsPerTask, count());
            for (std::uint64_t photon = t * kPhotonsPerTask; photon < end; ++photon) {
                const std::size_t e = emitter_of(photon);
                const auto departure = depart(e, photon);
                if (!departure || !emitters_[e].has_face()) continue;
                stored.clear();
                follow(*departure, RandomSequence(options_.seed, photon, 1), stored, ledger);
                const std::size_t cell = e * kCells + departure->cell;
                ++sent[cell];
                squares[cell] += stored.size() * stored.size();
            }
            rays += ledger.rays;
        });
        std::uint64_t all_sent = 0, all_squares = 0;
        for (std::size_t i = 0; i < sent.size(); ++i) {
            all_sent += sent[i];
            all_squares += squares[i];
        }
        if (all_squares > 0) {
            const double mean = static_cast<double>(all_squares) / static_cast<double>(all_sent);
            for (std::size_t e = 0; e < emitters_.size(); ++e) {
                if (!emitters_[e].has_face()) continue;
                std::vector<double> weight(kCells);
                for (std::size_t i = 0; i < kCells; ++i) {
                    // With one photon of the mean's worth beside the cell's own.
                    const double n = static_cast<double>(sent[e * kCells + i]) + 1.0;
                    const double square = (static_cast<double>(squares[e * kCells + i]) + mean) / n;
                    weight[i] = std::sqrt(square + kAimFloor * mean);
                }
                emitters_[e].set_aim(weight);
            }
        }
        share_out(wanted_);
        return rays;
    }

    void trace(std::uint64_t photon, std::vector<Photon>& stored, PhotonLedger& ledger) const {
        if (const auto departure = depart(emitter_of(photon), photon)) {
            ledger.emitted += static_cast<double>(luminance(departure->flux));
            ++ledger.photons;
            follow(*departure, RandomSequence(options_.seed, photon, 0), stored, ledger);
        }
    }

  private:
    /// Which photons are whose: by worth, each source at least one.
    void share_out(std::uint64_t count) {
        double total = 0.0, before = 0.0;
        for (const Emitter& emitter : emitters_) total += emitter.worth();
        const double n = static_cast<double>(count);
        first_.assign(1, 0);
        for (const Emitter& emitter : emitters_) {
            const double after = before + emitter.worth();
            const std::uint64_t share =
                static_cast<std::uint64_t>(std::llround(after / total * n) - std::llround(before / total * n));
            first_.push_back(first_.back() + std::max<std::uint64_t>(share, 1));
            before = after;
        }
    }

    std::size_t emitter_of(std::uint64_t photon) const {
        return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), photon) - first_.begin()) - 1;
    }

    std::optional<Departure> depart(std::size_t e, std::uint64_t photon) const {
        return emitters_[e].depart(sources_, sequences_[e], photon - first_[e], first_[e + 1] - first_[e]);
    }

    void follow(const Departure& departure, RandomSequence random, std::vector<Photon>& stored,
                PhotonLedger& ledger) const {
        Rgb flux = departure.flux;
        double lumen = static_cast<double>(luminance(flux));
        Vec3f origin = departure.origin, direction = departure.direction;
        Flight flight(scene_, rays_);
        for (int reflections = 0;; ++reflections) {
            const auto end = flight.end(origin, direction, random);
            ++ledger.rays;
            if (reflections > 0) {
                for (const SurfacePoint& crown : flight.passed())
                    stored.emplace_back(crown.position, crown.normal, flux);
            }
            if (!end) {
                ledger.escaped += lumen;
                return;
            }
            const SurfacePoint& surface = *end;
            if (reflections > 0 && !surface.is_leaf) stored.emplace_back(surface.position, surface.normal, flux);
            if (reflections == options_.bounces) {
                ledger.at_limit += lumen;
                return;
            }
            const Rgb reflected = flux * surface.albedo;
            const float survival = luminance(reflected) / luminance(flux);
            if (reflections == 0) {
                // Nothing was stored yet: a photon that ended here would be traced in vain.
                ledger.absorbed += lumen * (1.0 - static_cast<double>(survival));
                lumen *= static_cast<double>(survival);
                if (!(survival > 0.0f)) return;
                flux = reflected;
            } else {
                if (!(random.next() < survival)) {
                    ledger.absorbed += lumen;
                    return;
                }
                flux = reflected / survival;
            }
            const float u = random.next(), v = random.next();
            direction = surface.reflected_direction(u, v);
            origin = surface.position + rays_.surface_offset() * surface.normal;
        }
    }

    const LightSources& sources_;
    const Scene& scene_;
    const RayScene& rays_;
    const PhotonOptions& options_;
    std::uint64_t wanted_;
    std::vector<BoxFace> faces_;
    std::vector<Emitter> emitters_;
    std::vector<DepartureSequence> sequences_;  // [emitter]
    std::vector<std::uint64_t> first_;          // [emitter]: its first photon; one more than there are emitters
};

}  // namespace

std::uint64_t default_photon_count(const Scene& scene) {
    constexpr double kPerSquareMetre = 40.0;
    return static_cast<std::uint64_t>(std::clamp(kPerSquareMetre * surface_area(scene), 1e6, 2e8));
}

PhotonRun trace_photons(const LightSources& sources, const Scene& scene, const RayScene& rays,
                        const PhotonOptions& options, Progress& progress) {
    PhotonRun run;
    if (scene.triangles.empty()) return run;
    PhotonTracer tracer(sources, scene, rays, options);
    run.ledger.rays = tracer.aim();
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
