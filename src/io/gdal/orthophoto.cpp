#include "io/gdal/orthophoto.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "base/rgb.h"
#include "city/finding_codes.h"
#include "city/polygon.h"
#include "io/assembly/file_format.h"
#include "io/gdal/gdal_file.h"
#include "io/image/image.h"
#include "scene/scene.h"

namespace skybake::io {
namespace {

constexpr std::array<const char*, 3> kDrivers = {"GTiff", "PNG", "JPEG"};
/// A texture's longest side: what WebGL 2 promises is half of it, what every graphics card of ten years has is more.
constexpr double kLongestTexture = 4096.0;
/// Surfaces share a texture by the square that their middle lies in; what they reach beyond it still fits mostly.
constexpr double kSquare = 3584.0;
/// Steeper ground, more than 72°, shows a photo from above as stripes only.
constexpr double kLeastUpward = 0.3;

/// Where the city's ground lies in the picture.
class Places {
  public:
    Places(GDALDataset& dataset, const std::string& city_crs, const std::string& name) {
        std::array<double, 6> to_map{};
        if (dataset.GetGeoTransform(to_map.data()) != CE_None || !GDALInvGeoTransform(to_map.data(), to_pixel_.data()))
            throw InputError(fmt::format(
                "{}: does not say where it lies. Write it anew with gdal_translate -a_ullr, or add a world file.",
                name));
        const OGRSpatialReference* photo = dataset.GetSpatialRef();
        if (!photo || photo->IsEmpty() || city_crs.empty()) return;
        OGRSpatialReference from, to = *photo;
        if (from.SetFromUserInput(city_crs.c_str()) != OGRERR_NONE)
            throw InputError(fmt::format(
                "{}: its place in the city's system '{}' is unknown. Warp it into that system with gdalwarp.", name,
                city_crs));
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        from.StripVertical();
        to.StripVertical();
        if (from.IsSame(&to)) return;
        transformation_.reset(OGRCreateCoordinateTransformation(&from, &to));
        if (!transformation_)
            throw InputError(fmt::format(
                "{}: no way is known from the city's system '{}' to its own. Warp it with gdalwarp.", name, city_crs));
    }

    /// Columns and rows from the upper left corner of the picture; not finite where there is no such place.
    Vec2d operator()(const Vec3d& p) const {
        double x = p.x, y = p.y;
        if (transformation_ && !transformation_->Transform(1, &x, &y)) return Vec2d(NAN);
        return {to_pixel_[0] + to_pixel_[1] * x + to_pixel_[2] * y, to_pixel_[3] + to_pixel_[4] * x + to_pixel_[5] * y};
    }

  private:
    struct Deleter {
        void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
    };
    std::array<double, 6> to_pixel_{};
    std::unique_ptr<OGRCoordinateTransformation, Deleter> transformation_;
};

/// Surfaces that share a texture, and what of the picture they show.
struct Sheet {
    struct Part {
        std::size_t object = 0;
        std::size_t surface = 0;
    };
    std::vector<Part> parts;
    Box2d window;  // pixels of the picture; may reach beyond it
};

class Orthophoto {
  public:
    Orthophoto(const std::filesystem::path& path, const std::string& city_crs)
        : name_(path.string()),
          dataset_(open_dataset(path, GDAL_OF_RASTER, kDrivers)),
          places_(*dataset_, city_crs, name_) {
        const int bands = dataset_->GetRasterCount();
        if (bands < 1 || dataset_->GetRasterBand(1)->GetRasterDataType() != GDT_Byte ||
            dataset_->GetRasterBand(1)->GetColorTable())
            throw InputError(
                fmt::format("{}: is no picture of 8 bits a colour. Convert it with gdal_translate -ot Byte, a palette "
                            "with -expand rgb.",
                            name_));
        channels_ = bands >= 3 ? 3 : 1;
    }

    double columns() const { return dataset_->GetRasterXSize(); }
    double rows() const { return dataset_->GetRasterYSize(); }
    Vec2d place(const Vec3d& p) const { return places_(p); }

    /// The window as a picture, what is not there in the colour of default ground.
    Image8 cut(const Box2d& window) const {
        const Vec2d size = window.hi - window.lo;
        const double scale = std::min(1.0, kLongestTexture / std::max(size.x, size.y));
        const auto pixels = [&](double v) { return std::max(1, static_cast<int>(std::ceil(v * scale))); };
        Image8 image{pixels(size.x), pixels(size.y), 3, {}};
        const Rgb ground = default_albedo(SurfaceType::terrain);
        const std::size_t all = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
        for (std::size_t i = 0; i < all; ++i) {
            for (int c = 0; c < 3; ++c)
                image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(ground[c]))));
        }
        // The part that is there, in whole pixels of the result.
        const Vec2d per_pixel = size / Vec2d(image.width, image.height);
        const auto first = [](double lo, double step) { return std::max(0, static_cast<int>(std::ceil(-lo / step))); };
        const auto end = [](double lo, double step, double most, int count) {
            return std::min(count, static_cast<int>(std::floor((most - lo) / step)));
        };
        const int x0 = first(window.lo.x, per_pixel.x), y0 = first(window.lo.y, per_pixel.y);
        const int x1 = end(window.lo.x, per_pixel.x, columns(), image.width),
                  y1 = end(window.lo.y, per_pixel.y, rows(), image.height);
        if (x1 <= x0 || y1 <= y0) return image;
        const Box2d there{window.lo + Vec2d(x0, y0) * per_pixel, window.lo + Vec2d(x1, y1) * per_pixel};
        const std::size_t count = static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
        std::vector<std::uint8_t> mask(count), band(count);
        read(*dataset_->GetRasterBand(1)->GetMaskBand(), there, x1 - x0, y1 - y0, mask);
        for (int c = 0; c < 3; ++c) {
            if (c < channels_) read(*dataset_->GetRasterBand(c + 1), there, x1 - x0, y1 - y0, band);
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t x = static_cast<std::size_t>(x0) + i % static_cast<std::size_t>(x1 - x0);
                const std::size_t y = static_cast<std::size_t>(y0) + i / static_cast<std::size_t>(x1 - x0);
                if (mask[i] >= 128)
                    image.pixels[(y * static_cast<std::size_t>(image.width) + x) * 3 + static_cast<std::size_t>(c)] =
                        band[i];
            }
        }
        return image;
    }

  private:
    void read(GDALRasterBand& band, const Box2d& window, int width, int height, std::vector<std::uint8_t>& into) const {
        GDALRasterIOExtraArg how;
        INIT_RASTERIO_EXTRA_ARG(how);
        how.eResampleAlg = GRIORA_Bilinear;  // where the result is coarser, GDAL widens it to the pixels that it covers
        how.bFloatingPointWindowValidity = TRUE;
        how.dfXOff = window.lo.x;
        how.dfYOff = window.lo.y;
        how.dfXSize = window.hi.x - window.lo.x;
        how.dfYSize = window.hi.y - window.lo.y;
        const int x = static_cast<int>(how.dfXOff), y = static_cast<int>(how.dfYOff);
        const int right = std::min(dataset_->GetRasterXSize(), static_cast<int>(std::ceil(window.hi.x)));
        const int bottom = std::min(dataset_->GetRasterYSize(), static_cast<int>(std::ceil(window.hi.y)));
        if (band.RasterIO(GF_Read, x, y, std::max(1, right - x), std::max(1, bottom - y), into.data(), width, height,
                          GDT_Byte, 0, 0, &how) != CE_None)
            throw InputError(
                fmt::format("{}: is damaged: its pixels cannot be read. Write it anew with gdal_translate.", name_));
    }

    std::string name_;
    DatasetPtr dataset_;
    Places places_;
    int channels_ = 3;
};

void put_texture(CityObject& object, const Surface& surface, const Box2d& window, const Orthophoto& photo) {
    Geometry& g = object.geometry;
    g.corner_uv.resize(g.corners.size(), Vec2f(0.0f));
    for (std::uint32_t c = g.ring_first[surface.ring_begin]; c < g.ring_first[surface.ring_end]; ++c) {
        const Vec2d uv = (photo.place(g.vertices[g.corners[c]]) - window.lo) / (window.hi - window.lo);
        g.corner_uv[c] = Vec2f(static_cast<float>(uv.x), static_cast<float>(1.0 - uv.y));
    }
}

}  // namespace

void drape_orthophoto(const std::filesystem::path& path, const std::string& city_crs, CityModel& city,
                      FindingLog& findings) {
    checked_file_size(path);
    const QuietErrors quiet;
    const Orthophoto photo(path, city_crs);
    const Box2d all{{0.0, 0.0}, {photo.columns(), photo.rows()}};
    std::map<std::pair<int, int>, Sheet> sheets;
    std::size_t count = 0, partly = 0;
    for (std::size_t o = 0; o < city.objects.size(); ++o) {
        const Geometry& g = city.objects[o].geometry;
        for (std::size_t s = 0; s < g.surfaces.size() && is_ground(city.objects[o].type); ++s) {
            const Vec3d area = surface_area_vector(g, g.surfaces[s]);
            if (g.surfaces[s].texture || area.z < kLeastUpward * glm::length(area)) continue;
            Box2d box;
            bool is_finite = true;
            for (const std::uint32_t vertex : ring_of(g, g.surfaces[s].ring_begin)) {
                const Vec2d p = photo.place(g.vertices[vertex]);
                is_finite = is_finite && std::isfinite(p.x) && std::isfinite(p.y);
                box.extend(p);
            }
            const bool is_over = box.lo.x < all.hi.x && box.lo.y < all.hi.y && box.hi.x > 0.0 && box.hi.y > 0.0;
            if (!is_finite || !is_over) continue;
            ++count;
            partly += box.lo.x < 0.0 || box.lo.y < 0.0 || box.hi.x > all.hi.x || box.hi.y > all.hi.y;
            const Vec2d middle = glm::clamp((box.lo + box.hi) * 0.5, all.lo, all.hi);
            Sheet& sheet = sheets[{static_cast<int>(middle.x / kSquare), static_cast<int>(middle.y / kSquare)}];
            sheet.parts.push_back({o, s});
            sheet.window.extend(box.lo);
            sheet.window.extend(box.hi);
        }
    }
    if (count == 0) {
        throw InputError(
            fmt::format("{}: covers no ground of the city. Is it of the same place and system? A city without ground "
                        "gets one by --ground draped.",
                        path.string()));
    }
    for (auto& [square, sheet] : sheets) {
        Texture texture;
        texture.uri = fmt::format("{}#{}-{}.png", path.filename().string(), square.first, square.second);
        texture.wrap = TextureWrap::clamp;
        texture.embedded = std::make_shared<const std::vector<std::uint8_t>>(encode_png(photo.cut(sheet.window)));
        const TextureId id(city.textures.size());
        city.textures.push_back(std::move(texture));
        for (const Sheet::Part& part : sheet.parts) {
            Surface& surface = city.objects[part.object].geometry.surfaces[part.surface];
            surface.texture = id;
            put_texture(city.objects[part.object], surface, sheet.window, photo);
        }
    }
    findings.add(make_finding("SB505", path.filename().string(),
                              fmt::format("lies on {} surfaces of ground, {} of which reach beyond it, in {} textures.",
                                          count, partly, sheets.size())));
}

}  // namespace skybake::io
