// What the pages of others show of somebody who was deleted.
#include <gtest/gtest.h>

#include "service_lab.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;
using namespace testing;

/// Pages that compare people, and the values that they are made of: of this person nothing is left, in none of them.
TEST(DeletionOfAPerson, UpdatesStatisticsOfOthersAtOnce) {
  ServiceLab lab;
  lab.log_in();
  const auto get = [&](const std::string& target) {
    const HttpAnswer answer = lab.get(target);
    EXPECT_EQ(answer.status, 200) << target << " " << body_of(answer);
    return json_of(answer);
  };
  const auto anna = lab.add_person("Anna"), ben = lab.add_person("Ben"),
             expert = lab.add_person("Expert", results::Group::kExpert);
  lab.add_attempt(anna, 10.0);
  lab.add_attempt(ben, 50.0);
  lab.add_attempt(expert, 90.0);
  const std::string curve = "/api/people/" + ben.id + "/curve?task=liver-biopsy";
  EXPECT_EQ(get(curve)["peers"]["n"], 1);
  const auto counted = [&] {
    const Json score = get("/api/metrics/score?task=liver-biopsy");
    std::int64_t people = 0;
    for (const Json& group : score["groups"]) people += group["n"].get<int>();
    return people;
  };
  EXPECT_EQ(counted(), 3);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/people/" + anna.id, {{"confirm", "Anna"}})).status, 204);
  EXPECT_EQ(get(curve)["peers"]["n"], 0);
  EXPECT_EQ(counted(), 2);
  EXPECT_EQ(body_of(lab.get("/api/export/attempts.csv")).find("Anna"), std::string::npos);
  // By another program: within a second.
  ASSERT_TRUE(results::delete_person(lab.repository(), expert.id));
  lab.pass(1s);
  EXPECT_EQ(counted(), 1);
}

}  // namespace
}  // namespace trocar::web
