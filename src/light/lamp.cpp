#include "light/lamp.h"

#include <algorithm>
#include <cmath>

#include "light/surfaces.h"
#include "sky/colour.h"
#include "sky/spectral_tables.h"

namespace skybake {

namespace {

float share_at(const Lamp& lamp, float angle_rad) {
    if (angle_rad >= lamp.cone_half_angle_rad) return 0.0f;
    if (!(lamp.blend_rad > 0.0f)) return 1.0f;
    const float t = std::clamp((lamp.cone_half_angle_rad - angle_rad) / lamp.blend_rad, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// The direction of C = 90°: seen along the axis from behind, C turns counter-clockwise.
Vec3f c_quarter(const Lamp& lamp) {
    return glm::cross(lamp.c_zero, lamp.axis);
}

float angle_off_axis(const Lamp& lamp, const Vec3f& direction) {
    return std::acos(std::clamp(glm::dot(lamp.axis, direction), -1.0f, 1.0f));
}

}  // namespace

float intensity_share(const Lamp& lamp, const Vec3f& direction) {
    if (lamp.type == Lamp::Type::point) return 1.0f;
    if (lamp.type == Lamp::Type::spot) return share_at(lamp, angle_off_axis(lamp, direction));
    return lamp.profile->share(
        {glm::dot(direction, lamp.c_zero), glm::dot(direction, c_quarter(lamp)), glm::dot(direction, lamp.axis)});
}

float largest_intensity_share(const Lamp& lamp, const Vec3f& direction, float half_angle_rad) {
    if (lamp.type == Lamp::Type::point) return 1.0f;
    const float angle = angle_off_axis(lamp, direction);
    const float low = std::max(0.0f, angle - half_angle_rad);
    if (lamp.type == Lamp::Type::spot) return share_at(lamp, low);
    return lamp.profile->largest_share(low, std::min(static_cast<float>(kPi), angle + half_angle_rad));
}

LampSample sample_lamp(const Lamp& lamp, float u, float v) {
    if (lamp.type == Lamp::Type::profile) {
        const LightProfile::Sample sample = lamp.profile->sample(u, v);
        return {glm::normalize(sample.local.x * lamp.c_zero + sample.local.y * c_quarter(lamp) +
                               sample.local.z * lamp.axis),
                sample.pdf_solid_angle};
    }
    const double lowest =
        lamp.type == Lamp::Type::point ? -1.0 : std::cos(static_cast<double>(lamp.cone_half_angle_rad));
    const float z = static_cast<float>(lowest + (1.0 - lowest) * static_cast<double>(u));
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z)), turn = static_cast<float>(2.0 * kPi) * v;
    const TangentFrame frame = tangent_frame(lamp.axis);
    return {glm::normalize(r * std::cos(turn) * frame.u + r * std::sin(turn) * frame.v + z * lamp.axis),
            1.0 / (2.0 * kPi * (1.0 - lowest))};
}

double effective_solid_angle(const Lamp& lamp) {
    if (lamp.type == Lamp::Type::point) return 4.0 * kPi;
    if (lamp.type == Lamp::Type::profile) return lamp.profile->solid_angle();
    // The full part in closed form, the blend by the midpoint rule.
    const double outer = static_cast<double>(lamp.cone_half_angle_rad);
    const double inner = std::max(0.0, outer - static_cast<double>(lamp.blend_rad));
    double sum = 2.0 * kPi * (1.0 - std::cos(inner));
    constexpr int kSteps = 1024;
    for (int i = 0; i < kSteps && outer > inner; ++i) {
        const double angle = inner + (outer - inner) * (i + 0.5) / kSteps;
        sum += 2.0 * kPi * std::sin(angle) * static_cast<double>(share_at(lamp, static_cast<float>(angle))) *
               (outer - inner) / kSteps;
    }
    return sum;
}

Rgb unobstructed_irradiance(const Lamp& lamp, const Vec3f& position, const Vec3f& normal) {
    const Vec3f to_lamp = lamp.position - position;
    const float distance2 = glm::dot(to_lamp, to_lamp);
    if (!(distance2 > 0.0f)) return Rgb(0.0f);
    const Vec3f direction = to_lamp / std::sqrt(distance2);
    const float cosine = glm::dot(normal, direction);
    if (cosine <= 0.0f) return Rgb(0.0f);
    return lamp.intensity * (intensity_share(lamp, -direction) * cosine / distance2);
}

Rgb black_body_colour(double kelvin) {
    constexpr double kSecondRadiationConstantNmK = 1.438776877e7;  // h c / k
    Xyz xyz(0.0);
    const auto observer = standard_observer();
    for (std::size_t i = 0; i < observer.size(); ++i) {
        const double lambda = kFirstLambdaNm + kLambdaStepNm * static_cast<double>(i);
        const double planck =
            std::pow(lambda / 560.0, -5.0) / std::expm1(kSecondRadiationConstantNmK / (lambda * kelvin));
        xyz += planck * Xyz(observer[i][0], observer[i][1], observer[i][2]);
    }
    return rgb_from_xyz(xyz / xyz.y);
}

}  // namespace skybake
