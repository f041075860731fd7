// City files of a few lines for tests, in a folder that goes away with the test.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

#include "api/load_city.h"

namespace skybake {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        static std::atomic<int> number{0};
        path_ = std::filesystem::temp_directory_path() /
                ("skybake-test-" + std::to_string(getpid()) + "-" + std::to_string(number++));
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

inline LoadedCity load(const std::filesystem::path& path, const LoadOptions& options = {}) {
    SilentProgress progress;
    return load_city(std::span(&path, 1), options, progress);
}

/// Loads `text` as a file of its own.
inline LoadedCity load_text(const std::string& text, const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load(folder.write("a.city.json", text), options);
}

/// The unit cube's corners and its six outward faces as a Solid's outer shell.
inline const std::string kCubeVertices =
    "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,1000],[1000,0,1000],[1000,1000,1000],[0,1000,1000]]";
inline const std::string kCubeShell = "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";
inline const std::string kTransform = R"("transform":{"scale":[0.001,0.001,0.001],"translate":[0,0,0]})";

/// A CityJSON 2.0 document; `more` is further members, ending in a comma.
inline std::string document(const std::string& objects, const std::string& vertices = kCubeVertices,
                            const std::string& more = "") {
    return R"({"type":"CityJSON","version":"2.0",)" + more + kTransform + R"(,"CityObjects":{)" + objects +
           R"(},"vertices":)" + vertices + "}";
}
inline std::string building(const std::string& geometry, const std::string& id = "b", const std::string& more = "") {
    return "\"" + id + R"(":{"type":"Building",)" + more + R"("geometry":[)" + geometry + "]}";
}
inline std::string solid(const std::string& lod = "2", const std::string& more = "") {
    return R"({"type":"Solid","lod":")" + lod + "\"," + more + R"("boundaries":[)" + kCubeShell + "]}";
}

}  // namespace skybake
