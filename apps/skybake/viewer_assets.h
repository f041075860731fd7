// The built walkthrough that goes with the program, and its way into a bake.
#pragma once

#include <filesystem>

namespace skybake::cli {

/// The folder with the built viewer (index.html and viewer/), found relative to the running program:
/// ../share/skybake/viewer, in the build tree as after installing. Throws InputError when it is not there.
std::filesystem::path viewer_assets();

/// Copies the walkthrough into a bake folder, in place of an older one: any web host can then show the folder. The page
/// itself comes last, so that a copy that broke off is not taken for whole. Throws InputError when there is no viewer,
/// or no room.
void copy_viewer(const std::filesystem::path& folder);

}  // namespace skybake::cli
