#include "database/database_url.h"

#include <gtest/gtest.h>

namespace trocar::database {
namespace {

TEST(DatabaseUrl, IsAFileWithoutAScheme) {
  for (const char* text : {"results.sqlite", "sqlite:results.sqlite", "sqlite://results.sqlite"}) {
    const auto url = parse_url(text);
    ASSERT_TRUE(url) << text;
    EXPECT_TRUE(url->is_sqlite());
    EXPECT_EQ(url->file, "results.sqlite");
    EXPECT_EQ(url->shown(), "results.sqlite");
  }
  EXPECT_EQ(parse_url("sqlite:///var/results.sqlite")->file, "/var/results.sqlite");
  EXPECT_EQ(parse_url("a b/c:d.sqlite")->file, "a b/c:d.sqlite");
}

TEST(DatabaseUrl, HidesItsPassword) {
  const auto url = parse_url("postgres://anna:geheim@db.example:5433/trocar?sslmode=require");
  ASSERT_TRUE(url);
  EXPECT_FALSE(url->is_sqlite());
  EXPECT_EQ(url->server, "postgresql://anna:geheim@db.example:5433/trocar?sslmode=require");
  EXPECT_EQ(url->shown(), "postgresql://anna@db.example:5433/trocar?sslmode=require");
  EXPECT_EQ(parse_url("postgresql://h/d?user=a&password=geheim&x=1")->shown(),
            "postgresql://h/d?user=a&password=...&x=1");
  EXPECT_EQ(parse_url("postgresql://a:p@q@h/d")->shown(), "postgresql://a@h/d");
  EXPECT_EQ(parse_url("postgresql://h:5432/d")->shown(), "postgresql://h:5432/d");
}

TEST(DatabaseUrl, IsRefusedIfItNamesNoDatabase) {
  for (const char* text : {"", "sqlite:", "mysql://host/name", "postgresql://", "postgresql://host",
                           "postgresql://host/", "postgresql://host/?user=a"}) {
    const auto url = parse_url(text);
    ASSERT_FALSE(url) << text;
    EXPECT_EQ(url.error().exit_status, 2) << text;
    EXPECT_FALSE(url.error().advice.empty());
  }
  EXPECT_FALSE(parse_url(std::string_view("a\0b", 3)));
}

}  // namespace
}  // namespace trocar::database
