// Threads and lists of folders have one place each, which gives errors instead of exceptions.
#include "architecture/throwing_forms.h"

#include <gtest/gtest.h>

#include "architecture/source_files.h"

namespace trocar::architecture {
namespace {

std::size_t forms_in(std::string_view source) {
  return find_throwing_forms("src/device/server/a.cpp", source).size();
}

TEST(ThrowingForms, IncludeStartedThreads) {
  for (const char* source :
       {"thread_ = std::thread([this] { run(); });", "std::thread(watch).detach();", "std::jthread reader([&] {});",
        "std::thread t{f};", "thread_ = std::jthread(\n    work);", "Worker() : thread_([this] { run(); }) {}",
        "threads_.emplace_back([this] { work(); });", "auto t = std::make_unique<std::thread>(f);",
        "auto f = std::async(std::launch::async, g);", "pthread_create(&t, nullptr, f, nullptr);"})
    EXPECT_EQ(forms_in(source), 1u) << source;
}

TEST(ThrowingForms, IncludeFolderIterators) {
  for (const char* source : {"for (const auto& entry : fs::directory_iterator(folder, error)) use(entry);",
                             "fs::recursive_directory_iterator at(folder, error);\n++at;",
                             "for (std::filesystem::directory_iterator it(f, e), end; it != end; it.increment(e)) {}"})
    EXPECT_EQ(forms_in(source), 1u) << source;
}

TEST(ThrowingForms, ExcludeThreadMembersAndComments) {
  for (const char* source :
       {"std::thread thread_;", "std::vector<std::jthread> threads_;", "for (std::thread& t : threads_) t.join();",
        "Result<std::thread> make(std::function<void()> body);", "std::thread::hardware_concurrency()",
        "TROCAR_TRY(thread_, start_thread(\"device\", [this] { run(); }));", "// std::thread(f), directory_iterator(x)",
        "/* std::async\n directory_iterator */", "say(\"std::thread(f) \\\" directory_iterator\");",
        "std::this_thread::sleep_for(x);", "thread_ = {};", "std::thread none;"})
    EXPECT_EQ(forms_in(source), 0u) << source;
}

TEST(ThrowingForms, ReportLineAndAllowedModule) {
  const std::string source = "\n// a\nauto f = std::async(g);\n";
  EXPECT_EQ(find_throwing_forms("apps/a.cpp", source),
            std::vector<std::string>{"apps/a.cpp:3: start threads with core/start_thread.h"});
  EXPECT_TRUE(find_throwing_forms("src/foundation/core/start_thread.h", source).empty());
  EXPECT_EQ(find_throwing_forms("src/foundation/core/start_thread.cpp", "fs::directory_iterator(x)").size(), 1u);
}

TEST(ThrowingForms, AreNowhereInThePrograms) {
  std::string complaints;
  std::size_t files = 0;
  for (const auto& [path, text] : source_files({"src", "apps"})) {
    const bool is_of_tests = path.find("/test/") != std::string::npos || path.find("/testing/") != std::string::npos ||
                             path.find("/fuzz/") != std::string::npos;
    if (is_of_tests) continue;
    ++files;
    complaints += joined(find_throwing_forms(path, text));
  }
  EXPECT_EQ(complaints, "");
  EXPECT_GT(files, 500u);
}

}  // namespace
}  // namespace trocar::architecture
