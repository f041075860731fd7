#include "viewer_assets.h"

#include <fmt/format.h>

#include <system_error>

#include "base/error.h"

namespace skybake::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPage = "index.html";
constexpr const char* kParts = "viewer";  // what the page loads (viewer/vite.config.ts: assetsDir)

}  // namespace

fs::path viewer_assets() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path folder = program.parent_path().parent_path() / "share" / "skybake" / "viewer";
    if (error || !fs::is_regular_file(folder / kPage, error)) {
        throw InputError(fmt::format(
            "{}: the walkthrough is not built. Run `make viewer` in the source folder (it needs Node 18 or newer).",
            folder.string()));
    }
    return folder;
}

void copy_viewer(const fs::path& folder) {
    const fs::path source = viewer_assets();
    try {
        fs::create_directories(folder);
        fs::remove(folder / kPage);
        fs::remove_all(folder / kParts);
        fs::copy(source / kParts, folder / kParts, fs::copy_options::recursive);
        fs::copy_file(source / kPage, folder / kPage);
    } catch (const fs::filesystem_error& error) {
        throw InputError(
            fmt::format("{}: the walkthrough cannot be written: {}.", folder.string(), error.code().message()));
    }
}

}  // namespace skybake::cli
