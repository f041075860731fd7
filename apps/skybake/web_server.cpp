#include "web_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <libdeflate.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace skybake::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kBlock = std::size_t{1} << 18;

/// An open file, read at any place by several threads.
class OpenFile {
  public:
    explicit OpenFile(const fs::path& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    ~OpenFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    /// Bytes read; 0 at the end and on errors.
    std::size_t read_at(std::size_t offset, char* buffer, std::size_t size) const {
        const ssize_t count = ::pread(descriptor_, buffer, size, static_cast<off_t>(offset));
        return count > 0 ? static_cast<std::size_t>(count) : 0;
    }

  private:
    int descriptor_;
};

bool is_own_name(std::string host) {
    if (const std::size_t colon = host.rfind(':'); colon != std::string::npos) host.resize(colon);
    return host == kLoopback || host == "localhost";
}

void answer_text(httplib::Response& response, int status, const std::string& text) {
    response.status = status;
    response.set_content(text + "\n", "text/plain; charset=utf-8");
}

void set_common_headers(httplib::Response& response) {
    response.set_header("Cache-Control", "no-cache");  // the same folder may be baked again
    response.set_header("X-Content-Type-Options", "nosniff");
}

using Bytes = std::vector<std::uint8_t>;

/// Whether the browser takes gzip (RFC 9110, section 12.5.3): named, or meant by `*`, and not with weight 0.
bool accepts_gzip(std::string_view header) {
    bool is_accepted = false;
    while (!header.empty()) {
        const std::string_view entry = header.substr(0, header.find(','));
        header.remove_prefix(std::min(entry.size() + 1, header.size()));
        const std::string_view coding = entry.substr(0, entry.find(';'));
        const std::size_t begin = coding.find_first_not_of(" \t");
        const std::size_t end = coding.find_last_not_of(" \t");
        if (begin == std::string_view::npos) continue;
        const std::string_view name = coding.substr(begin, end - begin + 1);
        const std::size_t weight = entry.find("q=");
        const bool is_refused =
            weight != std::string_view::npos && entry.find_first_not_of("0. \t", weight + 2) == std::string_view::npos;
        if (name == "gzip") return !is_refused;
        if (name == "*") is_accepted = !is_refused;
    }
    return is_accepted;
}

/// Files that gzip makes smaller; pictures are packed already.
bool is_compressible(const fs::path& path) {
    static constexpr std::array<std::string_view, 10> kEndings{".html", ".js",  ".css", ".json", ".txt",
                                                               ".csv",  ".svg", ".glb", ".bin",  ".wasm"};
    return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
}

/// Gzipped files, kept as long as the file stays as it was.
class GzipCache {
  public:
    /// Null when the file is too large to be held, cannot be read, or does not become smaller.
    std::shared_ptr<const Bytes> packed(const fs::path& path) {
        std::error_code error;
        const std::uintmax_t size = fs::file_size(path, error);
        const auto time = error ? fs::file_time_type() : fs::last_write_time(path, error);
        if (error || size < kSmallest || size > kLargest) return nullptr;
        const std::lock_guard lock(mutex_);
        const auto found = entries_.find(path.string());
        if (found != entries_.end() && found->second.size == size && found->second.time == time)
            return found->second.bytes;
        if (held_ > kLargest) {
            entries_.clear();
            held_ = 0;
        }
        const std::shared_ptr<const Bytes> bytes = gzipped(path, static_cast<std::size_t>(size));
        if (bytes) held_ += bytes->size();
        entries_[path.string()] = {size, time, bytes};
        return bytes;
    }

  private:
    static constexpr std::uintmax_t kSmallest = 256;  // a header would eat the gain
    static constexpr std::uintmax_t kLargest = std::uintmax_t{1} << 28;
    static constexpr int kLevel = 3;  // some 100 MB a second

    static std::shared_ptr<const Bytes> gzipped(const fs::path& path, std::size_t size) {
        const OpenFile file(path);
        Bytes raw(size);
        for (std::size_t at = 0; at < size;) {
            const std::size_t count =
                file.is_open() ? file.read_at(at, reinterpret_cast<char*>(&raw[at]), size - at) : 0;
            if (count == 0) return nullptr;
            at += count;
        }
        const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
            libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
        if (!compressor) return nullptr;
        Bytes packed(size);
        packed.resize(libdeflate_gzip_compress(compressor.get(), raw.data(), size, packed.data(), packed.size()));
        if (packed.empty()) return nullptr;  // it would not be smaller
        packed.shrink_to_fit();
        return std::make_shared<const Bytes>(std::move(packed));
    }

    struct Entry {
        std::uintmax_t size = 0;
        fs::file_time_type time;
        std::shared_ptr<const Bytes> bytes;
    };
    std::mutex mutex_;
    std::map<std::string, Entry> entries_;
    std::uintmax_t held_ = 0;  // bytes
};

void answer_file(const httplib::Request& request, httplib::Response& response, const fs::path& path, GzipCache& cache) {
    if (is_compressible(path)) {
        response.set_header("Vary", "Accept-Encoding");
        // Ranges count bytes of the plain file.
        if (request.ranges.empty() && accepts_gzip(request.get_header_value("Accept-Encoding"))) {
            if (const std::shared_ptr<const Bytes> packed = cache.packed(path)) {
                set_common_headers(response);
                response.set_header("Content-Encoding", "gzip");
                response.set_content_provider(
                    packed->size(), mime_type(path),
                    [packed](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                        return sink.write(reinterpret_cast<const char*>(packed->data()) + offset, length);
                    });
                return;
            }
        }
    }
    const auto file = std::make_shared<OpenFile>(path);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error || !file->is_open()) {
        answer_text(response, 404, "This file cannot be read.");
        return;
    }
    set_common_headers(response);
    const std::string type = mime_type(path);
    if (size == 0) {
        response.set_content("", type);
        return;
    }
    response.set_content_provider(static_cast<std::size_t>(size), type,
                                  [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      std::vector<char> block(std::min(length, kBlock));
                                      const std::size_t count = file->read_at(offset, block.data(), block.size());
                                      return count > 0 && sink.write(block.data(), count);
                                  });
}

bool is_within(const fs::path& root, const fs::path& path) {
    return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

}  // namespace

std::optional<fs::path> file_below(const fs::path& root, const std::string& url_path) {
    if (url_path.find('\0') != std::string::npos) return {};
    const fs::path relative = fs::path(url_path).relative_path();
    for (const fs::path& part : relative) {
        if (part == "..") return {};
    }
    std::error_code error;
    const fs::path whole_root = fs::canonical(root, error);
    if (error) return {};
    fs::path found = fs::canonical(root / relative, error);
    if (!error && fs::is_directory(found, error)) found = fs::canonical(found / "index.html", error);
    if (error || !is_within(whole_root, found) || !fs::is_regular_file(found, error)) return {};
    return found;
}

std::string mime_type(const fs::path& file) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kTypes{{
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".txt", "text/plain; charset=utf-8"},
        {".csv", "text/csv; charset=utf-8"},
        {".png", "image/png"},
        {".jpg", "image/jpeg"},
        {".svg", "image/svg+xml"},
        {".exr", "image/x-exr"},
        {".ktx2", "image/ktx2"},
        {".glb", "model/gltf-binary"},
        {".wasm", "application/wasm"},
        {".bin", "application/octet-stream"},
    }};
    const std::string ending = file.extension().string();
    for (const auto& [known, type] : kTypes) {
        if (ending == known) return std::string(type);
    }
    return "application/octet-stream";
}

struct WebServer::State {
    std::vector<fs::path> roots;
    std::map<std::string, fs::path> mounts;
    GzipCache packed;
    httplib::Server server;
};

WebServer::WebServer(std::vector<fs::path> roots, std::map<std::string, fs::path> mounts)
    : state_(std::make_unique<State>()) {
    state_->roots = std::move(roots);
    state_->mounts = std::move(mounts);
    httplib::Server& server = state_->server;
    // The library's own default, SO_REUSEPORT, would let two servers share a port unnoticed.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    server.set_keep_alive_timeout(2);
    server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
        if (is_own_name(request.get_header_value("Host"))) return httplib::Server::HandlerResponse::Unhandled;
        answer_text(response, 403, "This server answers only under the names 127.0.0.1 and localhost.");
        return httplib::Server::HandlerResponse::Handled;
    });
    server.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
        std::string path = request.path;
        std::vector<fs::path> folders = state_->roots;
        const std::size_t slash = path.find('/', 1);
        if (slash != std::string::npos) {
            if (const auto mount = state_->mounts.find(path.substr(1, slash - 1)); mount != state_->mounts.end()) {
                folders = {mount->second};
                path.erase(0, slash);
            }
        }
        for (const fs::path& root : folders) {
            if (const std::optional<fs::path> file = file_below(root, path)) {
                answer_file(request, response, *file, state_->packed);
                return;
            }
        }
        answer_text(response, 404, "There is no such file in this bake.");
    });
}

WebServer::~WebServer() = default;

int WebServer::bind(std::optional<int> port) {
    const int first = port.value_or(kFirstPort);
    const int last = port ? first : first + kPortsTried - 1;
    for (int candidate = first; candidate <= last; ++candidate) {
        if (state_->server.bind_to_port(kLoopback, candidate)) return candidate;
    }
    throw InputError(
        port ? fmt::format("port {} of 127.0.0.1 is taken. Leave --port away to get a free one.", first)
             : fmt::format("no port from {} to {} of 127.0.0.1 is free. Name one with --port.", first, last));
}

bool WebServer::run() {
    return state_->server.listen_after_bind();
}

void WebServer::stop() {
    state_->server.stop();
}

}  // namespace skybake::cli
