// Cache and files of the page.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "core/files/folders.h"
#include "core/testing/no_threads.h"
#include "web/static_files.h"
#include "web/test/service_lab.h"
#include "web/timed_cache.h"
#include "web/transport/detail/connection.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;
using testing::header_of;
const AnswerCache::TimePoint kFirstAsked{1000h};

AnswerCache::Value text(std::string content) {
  return std::make_shared<const std::string>(std::move(content));
}

TEST(AnswerCache, RenewsAnAnswerOncePerSecond) {
  AnswerCache cache;
  int made = 0;
  const auto make = [&]() -> Result<AnswerCache::Value> { return text(std::to_string(++made)); };
  EXPECT_EQ(**cache.get("a", kFirstAsked, make), "1");
  EXPECT_EQ(**cache.get("a", kFirstAsked + 999ms, make), "1");
  EXPECT_EQ(**cache.get("b", kFirstAsked, make), "2");
  EXPECT_EQ(**cache.get("a", kFirstAsked + 1000ms, make), "1") << "the old one, while the next is made";
  cache.finish_renewal();
  EXPECT_EQ(**cache.get("a", kFirstAsked + 1001ms, make), "3");
  cache.clear();
  EXPECT_EQ(**cache.get("a", kFirstAsked + 1002ms, make), "4");
  EXPECT_EQ(**cache.get("a", kFirstAsked + 60s, make), "5") << "too old to be given";
}

TEST(AnswerCache, DoesNotKeepErrors) {
  AnswerCache cache;
  EXPECT_FALSE(cache.get("a", kFirstAsked, [] { return fail("no", "where", "advice"); }));
  EXPECT_EQ(**cache.get("a", kFirstAsked, [] { return text("yes"); }), "yes");
}

TEST(AnswerCache, WaitersShareOneAnswer) {
  AnswerCache cache;
  std::atomic<int> made{0}, waiting{0};
  std::vector<std::thread> threads;
  std::atomic<bool> may_end{false};
  for (int n = 0; n < 8; ++n)
    threads.emplace_back([&] {
      ++waiting;
      const auto value = cache.get("a", kFirstAsked, [&]() -> Result<AnswerCache::Value> {
        ++made;
        while (!may_end) std::this_thread::yield();
        return text("once");
      });
      EXPECT_EQ(**value, "once");
    });
  while (waiting < 8) std::this_thread::yield();
  may_end = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
}

TEST(AnswerCache, NextRequestReceivesAFailedRenewal) {
  AnswerCache cache;
  ASSERT_TRUE(cache.get("a", kFirstAsked, [] { return text("old"); }));
  const auto no = []() -> Result<AnswerCache::Value> { return fail("no", "where", "advice"); };
  EXPECT_EQ(**cache.get("a", kFirstAsked + 2s, no), "old");
  cache.finish_renewal();
  EXPECT_FALSE(cache.get("a", kFirstAsked + 2s, no));
}

/// A deletion while an answer is being made: the answer may show the deleted person and must not be kept.
TEST(AnswerCache, DropsAnswersFromBeforeAChange) {
  AnswerCache cache;
  ASSERT_TRUE(cache.get("a", kFirstAsked, [&] {
    cache.clear();
    return text("before the change");
  }));
  EXPECT_EQ(**cache.get("a", kFirstAsked, [] { return text("after"); }), "after");
}

TEST(AnswerCache, IsBounded) {
  CacheRules rules;
  rules.most_entries = 3;
  rules.most_bytes = 100;
  AnswerCache cache(rules);
  int made = 0;
  const auto get = [&](const std::string& key, int second) {
    (void)cache.get(key, kFirstAsked + std::chrono::milliseconds(second), [&] {
      ++made;
      return text(std::string(30, 'x'));
    });
  };
  for (int n = 0; n < 4; ++n) get(std::to_string(n), n);
  get("3", 4);
  EXPECT_EQ(made, 4) << "the newest is kept";
  get("0", 5);
  EXPECT_EQ(made, 5) << "the oldest is not";
}

class Page : public ::testing::Test {
 protected:
  void write(const std::string& path, const std::string& content) {
    std::filesystem::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << content;
  }
  HttpAnswer get(const std::string& path, TextPairs headers = {}) {
    HttpRequest request;
    request.path = path;
    request.headers = std::move(headers);
    return StaticFiles::load(folder_.path()).value().answer(request);
  }
  void SetUp() override {
    write("index.html", "<html>");
    write("assets/index-1234.js", "code");
  }
  TemporaryFolder folder_;
};

TEST_F(Page, OwnPathsServeTheIndex) {
  for (const char* path : {"/", "/people/0123", "/q/token", "/unknown"}) EXPECT_EQ(*get(path).body, "<html>") << path;
  EXPECT_EQ(get("/").content_type, "text/html; charset=utf-8");
  EXPECT_EQ(header_of(get("/"), "Cache-Control"), "no-cache");
}

TEST_F(Page, AssetsAreCacheable) {
  const HttpAnswer script = get("/assets/index-1234.js");
  EXPECT_EQ(*script.body, "code");
  EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
  EXPECT_NE(header_of(script, "Cache-Control").find("immutable"), std::string::npos);
  const HttpAnswer again = get("/assets/index-1234.js", {{"If-None-Match", header_of(script, "ETag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_FALSE(again.body);
}

TEST_F(Page, OtherFilesAreUnreachable) {
  std::ofstream(folder_ / "../secret.txt") << "secret";
  for (const char* path :
       {"/../secret.txt", "/assets/../../secret.txt", "/..%2fsecret.txt", "//secret.txt", "/./index.html",
        "/assets//index-1234.js", "/etc/passwd.txt", "/index.html/../x.js", "\\..\\secret.txt", ""}) {
    const HttpAnswer answer = get(path);
    if (answer.status == 200) {
      EXPECT_EQ(*answer.body, "<html>") << path;
    }
  }
  EXPECT_EQ(get("/../secret.txt").status, 404);
  std::filesystem::remove(folder_ / "../secret.txt");
}

TEST_F(Page, RefusesOutsideLinksUnknownTypesAndAMissingIndex) {
  write("assets/tool.exe", "x");
  EXPECT_FALSE(StaticFiles::load(folder_.path()));
  std::filesystem::remove(folder_ / "assets/tool.exe");
  std::filesystem::create_symlink("/etc/hostname", folder_ / "assets/host.txt");
  EXPECT_FALSE(StaticFiles::load(folder_.path()));
  std::filesystem::remove(folder_ / "assets/host.txt");
  std::filesystem::remove(folder_ / "index.html");
  EXPECT_FALSE(StaticFiles::load(folder_.path()));
}

TEST(AnswerCache, RenewsInTheRequestWithoutAThread) {
  const trocar::testing::NoThreads none;
  AnswerCache cache;
  int made = 0;
  const auto make = [&]() -> Result<AnswerCache::Value> { return text(std::to_string(++made)); };
  EXPECT_EQ(**cache.get("a", kFirstAsked, make), "1");
  EXPECT_EQ(**cache.get("a", kFirstAsked + 999ms, make), "1");
  EXPECT_EQ(**cache.get("a", kFirstAsked + 1000ms, make), "2");
  cache.finish_renewal();
}

TEST(AnswerCache, ConvertsExceptionsToErrors) {
  AnswerCache cache;
  EXPECT_FALSE(cache.get("a", kFirstAsked, []() -> Result<AnswerCache::Value> { throw std::runtime_error("no"); }));
  EXPECT_EQ(**cache.get("a", kFirstAsked, [] { return text("yes"); }), "yes");
}

/// Whatever is thrown, and wherever: a later request makes the value again.
TEST(AnswerCache, RetriesAKeyWhoseValueFailed) {
  AnswerCache cache;
  EXPECT_FALSE(cache.get("a", kFirstAsked, []() -> Result<AnswerCache::Value> { throw 1; }));
  EXPECT_EQ(**cache.get("a", kFirstAsked, [] { return text("yes"); }), "yes");
  int counted = 0;
  TimedCache<std::string> fails_to_count([&](const std::string& value) {
    if (++counted == 1) throw std::runtime_error("no");
    return value.size();
  });
  EXPECT_THROW(static_cast<void>(fails_to_count.get("a", kFirstAsked, [] { return text("no"); })), std::runtime_error);
  EXPECT_EQ(**fails_to_count.get("a", kFirstAsked, [] { return text("yes"); }), "yes");
}

TEST(WorkerThreads, CallerRunsTheJobWithoutAThread) {
  std::atomic<int> waiting{0};
  int done = 0;
  detail::WorkerThreads workers(2, waiting);
  {
    const trocar::testing::NoThreads none;
    workers.enqueue([&] { ++done; });
    EXPECT_EQ(done, 1);
    EXPECT_EQ(waiting, 0);
  }
  workers.enqueue([&] { ++done; });
  workers.shutdown();
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace trocar::web
