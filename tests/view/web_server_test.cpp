// The web server of `skybake view`, asked over a real socket on the loopback interface.
#include "web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <libdeflate.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "base/error.h"

namespace skybake::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class WebServerTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "skybake-web-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        base_ = name;
        root_ = base_ / "bake";
        viewer_ = base_ / "viewer";
        fs::create_directories(root_ / "light");
        fs::create_directories(viewer_);
        put(root_ / "manifest.json", "{}");
        put(root_ / "city.glb", "0123456789");
        put(root_ / "empty.bin", "");
        put(root_ / "light" / "page one.png", "png");
        put(viewer_ / "index.html", "<!doctype html>");
        put(base_ / "secret.txt", "secret");
        fs::create_symlink(base_ / "secret.txt", root_ / "out.txt");
        fs::create_symlink(base_, root_ / "up");
        fs::create_symlink("city.glb", root_ / "same.glb");
        server_ = std::make_unique<WebServer>(std::vector{root_, viewer_});
        port_ = server_->bind(std::nullopt);
        thread_ = std::thread([this] { server_->run(); });
        client_ = std::make_unique<httplib::Client>("127.0.0.1", port_);
        client_->set_url_encode(false);  // paths go over the wire as the test writes them
        for (int i = 0; i < 100 && !client_->Get("/"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    void TearDown() override {
        server_->stop();
        thread_.join();
        fs::remove_all(base_);
    }
    static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

    fs::path base_, root_, viewer_;
    std::unique_ptr<WebServer> server_;
    std::thread thread_;
    std::unique_ptr<httplib::Client> client_;
    int port_ = 0;
};

TEST_F(WebServerTest, ServesFilesWithTheTypesThatBrowsersAskFor) {
    const auto glb = client_->Get("/city.glb");
    ASSERT_TRUE(glb);
    EXPECT_EQ(glb->status, 200);
    EXPECT_EQ(glb->body, "0123456789");
    EXPECT_EQ(glb->get_header_value("Content-Type"), "model/gltf-binary");
    EXPECT_EQ(client_->Get("/manifest.json")->get_header_value("Content-Type"), "application/json");
    EXPECT_EQ(client_->Get("/light/page%20one.png")->get_header_value("Content-Type"), "image/png");
    const auto empty = client_->Get("/empty.bin");
    EXPECT_EQ(empty->status, 200);
    EXPECT_EQ(empty->body, "");
    EXPECT_EQ(mime_type("a.js"), "text/javascript; charset=utf-8");
    EXPECT_EQ(mime_type("a.unheard"), "application/octet-stream");
}

TEST_F(WebServerTest, AFolderMeansItsPageAndTheSecondRootFillsIn) {
    const auto page = client_->Get("/");
    EXPECT_EQ(page->status, 200);
    EXPECT_EQ(page->body, "<!doctype html>");
    EXPECT_THAT(page->get_header_value("Content-Type"), StartsWith("text/html"));
    put(root_ / "index.html", "own");
    EXPECT_EQ(client_->Get("/")->body, "own");
}

TEST_F(WebServerTest, AnswersRangesAndHeads) {
    const auto part = client_->Get("/city.glb", {{"Range", "bytes=2-5"}});
    ASSERT_TRUE(part);
    EXPECT_EQ(part->status, 206);
    EXPECT_EQ(part->body, "2345");
    EXPECT_EQ(client_->Get("/city.glb", {{"Range", "bytes=-3"}})->body, "789");
    EXPECT_EQ(client_->Get("/city.glb", {{"Range", "bytes=7-"}})->body, "789");
    // What lies outside the file, or makes no sense, gives no byte beyond it and does not stop the server.
    for (const char* range :
         {"bytes=100-200", "bytes=5-2", "bytes=9-99", "bytes=-99", "bytes=99999999999999999999-", "bytes=x"}) {
        const auto answer = client_->Get("/city.glb", {{"Range", range}});
        if (answer) {
            EXPECT_LE(answer->body.size(), 600u) << range;
        }
        EXPECT_EQ(client_->Get("/city.glb")->body, "0123456789") << range;
    }
    const auto head = client_->Head("/city.glb");
    EXPECT_EQ(head->status, 200);
    EXPECT_EQ(head->get_header_value("Content-Length"), "10");
}

TEST_F(WebServerTest, TextAndGeometryAreGzippedForWhoAsks) {
    const std::string text(100000, 'a');
    put(root_ / "large.glb", text);
    put(root_ / "light" / "page.png", text);
    client_->set_decompress(false);
    const auto packed = client_->Get("/large.glb", {{"Accept-Encoding", "br, gzip;q=0.8"}});
    ASSERT_TRUE(packed);
    EXPECT_EQ(packed->get_header_value("Content-Encoding"), "gzip");
    EXPECT_EQ(packed->get_header_value("Content-Type"), "model/gltf-binary");
    EXPECT_EQ(packed->get_header_value("Vary"), "Accept-Encoding");
    EXPECT_LT(packed->body.size(), text.size() / 10);
    std::string whole(text.size(), '\0');
    std::size_t size = 0;
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    EXPECT_EQ(libdeflate_gzip_decompress(decompressor.get(), packed->body.data(), packed->body.size(), whole.data(),
                                         whole.size(), &size),
              LIBDEFLATE_SUCCESS);
    EXPECT_EQ(whole, text);
    // Plain for who does not ask, for parts, and for what is packed already.
    for (const char* coding : {"identity", "gzip;q=0", "gzip;q=0.0, *", "br", ""}) {
        const auto plain = client_->Get("/large.glb", {{"Accept-Encoding", coding}});
        EXPECT_FALSE(plain->has_header("Content-Encoding")) << coding;
        EXPECT_EQ(plain->body, text) << coding;
    }
    const auto part = client_->Get("/large.glb", {{"Accept-Encoding", "gzip"}, {"Range", "bytes=10-19"}});
    EXPECT_EQ(part->status, 206);
    EXPECT_EQ(part->body, "aaaaaaaaaa");
    EXPECT_FALSE(client_->Get("/light/page.png", {{"Accept-Encoding", "gzip"}})->has_header("Content-Encoding"));
    // A file that changed is packed anew.
    put(root_ / "large.glb", std::string(50000, 'b'));
    const auto changed = client_->Get("/large.glb", {{"Accept-Encoding", "*"}});
    EXPECT_EQ(libdeflate_gzip_decompress(decompressor.get(), changed->body.data(), changed->body.size(), whole.data(),
                                         whole.size(), &size),
              LIBDEFLATE_SUCCESS);
    EXPECT_EQ(whole.substr(0, size), std::string(50000, 'b'));
}

TEST_F(WebServerTest, WhatIsNotThereIs404InWords) {
    const auto missing = client_->Get("/light/none.png");
    EXPECT_EQ(missing->status, 404);
    EXPECT_THAT(missing->body, HasSubstr("no such file"));
    EXPECT_EQ(client_->Get("/light")->status, 404);  // a folder without a page is not listed
}

TEST_F(WebServerTest, NoWayLeadsOutOfTheFolder) {
    for (const char* path : {"/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/light/../../secret.txt",
                             "//secret.txt", "/out.txt", "/%252e%252e/secret.txt", "/..%5csecret.txt",
                             "/light%2f..%2f..%2fsecret.txt", "/up/secret.txt", "/city.glb%00.png"}) {
        const auto answer = client_->Get(path);
        ASSERT_TRUE(answer) << path;
        EXPECT_GE(answer->status, 400) << path;
        EXPECT_THAT(answer->body, testing::Not(HasSubstr("secret"))) << path;
    }
    EXPECT_EQ(client_->Get("/same.glb")->status, 200);  // a link that stays inside is a file like others
    EXPECT_EQ(file_below(root_, (base_ / "secret.txt").string()), std::nullopt);
}

TEST_F(WebServerTest, AnswersOnlyUnderItsOwnName) {
    EXPECT_EQ(client_->Get("/city.glb", {{"Host", "evil.example:8080"}})->status, 403);
    EXPECT_EQ(client_->Get("/city.glb", {{"Host", "localhost:" + std::to_string(port_)}})->status, 200);
}

TEST_F(WebServerTest, NothingCanBeWritten) {
    EXPECT_GE(client_->Put("/city.glb", "x", "text/plain")->status, 400);
    EXPECT_GE(client_->Delete("/city.glb")->status, 400);
    EXPECT_TRUE(fs::exists(root_ / "city.glb"));
}

TEST_F(WebServerTest, ATakenPortIsToldAndASecondServerFindsAFreeOne) {
    WebServer second({root_});
    EXPECT_THROW(
        {
            try {
                second.bind(port_);
            } catch (const InputError& error) {
                EXPECT_THAT(error.what(), HasSubstr("port " + std::to_string(port_) + " of 127.0.0.1 is taken"));
                throw;
            }
        },
        InputError);
    WebServer third({root_});
    EXPECT_NE(third.bind(std::nullopt), port_);
}

TEST_F(WebServerTest, ListensOnTheLoopbackAlone) {
    httplib::Client other("127.0.0.2", port_);
    EXPECT_FALSE(other.Get("/city.glb"));  // the same computer under another address: not bound
}

}  // namespace
}  // namespace skybake::cli
