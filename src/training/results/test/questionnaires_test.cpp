#include "results/questionnaires.h"

#include <cmath>

#include "results_lab.h"

namespace trocar::results {
namespace {

class Questionnaires : public ResultsTest {
 protected:
  Form add_default() {
    Form form = default_form();
    form.is_open = true;
    const auto added = add_form(*repository_, form, kNow);
    EXPECT_TRUE(added) << added.error().text();
    return added.value_or(Form{});
  }
  Status answer(const Form& form, const std::vector<int>& points, const std::string& text = {},
                const std::string& id = {}) {
    std::map<std::string, Answer, std::less<>> answers;
    for (std::size_t n = 0; n < points.size(); ++n) answers[form.items[n].id].points = points[n];
    if (!text.empty()) answers[form.items.back().id].text = text;
    return add_response(*repository_, form.token, id, answers, {}, kNow);
  }
};
TROCAR_BOTH_DATABASES(Questionnaires);

TEST_P(Questionnaires, GiveMeansPerItem) {
  const Form form = add_default();
  EXPECT_GE(form.token.size(), 22u);
  ASSERT_TRUE(answer(form, {1, 2, 3, 2}, "Good. <b>More bones!</b>\n'; DROP TABLE answers; --"));
  ASSERT_TRUE(answer(form, {2, 2, 2, 6}));
  const auto found = summarise_form(*repository_, form.id);
  ASSERT_TRUE(found && *found);
  const FormSummary& summary = **found;
  EXPECT_EQ(summary.form.responses, 2);
  ASSERT_EQ(summary.items.size(), 5u);
  EXPECT_EQ(summary.items[0].mean, 1.5);
  EXPECT_NEAR(*summary.items[0].sd, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(*summary.items[1].sd, 0.0);
  EXPECT_EQ(summary.items[3].mean, 4.0);
  EXPECT_EQ(summary.items[3].counts, (std::array<std::int64_t, 6>{0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(summary.items[4].n, 1);
  EXPECT_EQ(summary.items[4].comments.front().text, "Good. <b>More bones!</b>\n'; DROP TABLE answers; --");
  const auto csv = answers_csv(*repository_, form.id);
  ASSERT_TRUE(csv);
  EXPECT_NE(csv->find(",1,2,3,2,"), std::string::npos);
}

TEST_P(Questionnaires, RefuseInvalidAnswers) {
  const Form form = add_default();
  for (const std::vector<int>& points : {std::vector<int>{1, 2, 3}, {1, 2, 3, 7}, {1, 2, 3, -1}, {}}) {
    const Status refused = answer(form, points);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().exit_status, 2);
  }
  EXPECT_FALSE(answer(form, {1, 1, 1, 1}, std::string(kMaxAnswerCharacters + 1, 'x')));
  EXPECT_TRUE(answer(form, {1, 1, 1, 1}, std::string(kMaxAnswerCharacters, 'x')));
  EXPECT_FALSE(add_response(*repository_, form.token, {}, {{"unknown", Answer{1, {}}}}, {}, kNow));
  EXPECT_FALSE(add_response(*repository_, "guessed", {}, {}, {}, kNow));
  EXPECT_EQ(find_form(*repository_, form.id)->value().responses, 1);
}

TEST_P(Questionnaires, CountARepeatedResponseOnce) {
  const Form form = add_default();
  const std::string id = make_id();
  ASSERT_TRUE(answer(form, {1, 1, 1, 1}, "a", id));
  ASSERT_TRUE(answer(form, {6, 6, 6, 6}, "b", id));
  const auto summary = summarise_form(*repository_, form.id);
  EXPECT_EQ((*summary)->items[0].n, 1);
  EXPECT_EQ((*summary)->items[0].mean, 1.0);
}

TEST_P(Questionnaires, AreClosedToAnswers) {
  Form form = add_default();
  EXPECT_TRUE(find_open_form(*repository_, form.token)->has_value());
  form.is_open = false;
  ASSERT_TRUE(change_form(*repository_, form, kNow));
  EXPECT_FALSE(find_open_form(*repository_, form.token)->has_value());
  EXPECT_FALSE(answer(form, {1, 1, 1, 1}));
}

TEST_P(Questionnaires, NeverChangeTheTextOfAnAnsweredItem) {
  Form form = add_default();
  // Without answers an item is changed in place.
  form.items[0].text = "Training with the simulator is useful for me.";
  const std::string first = form.items[0].id;
  form = *change_form(*repository_, form, kNow);
  EXPECT_EQ(form.items[0].id, first);
  ASSERT_TRUE(answer(form, {1, 1, 1, 1}));
  form.items[0].text = "Training is useless.";
  std::swap(form.items[1], form.items[2]);
  form.items.pop_back();  // nobody answered it: it is gone
  form = *change_form(*repository_, form, kNow);
  EXPECT_NE(form.items[0].id, first);
  const FormSummary summary = **summarise_form(*repository_, form.id);
  ASSERT_EQ(summary.items.size(), 5u);
  EXPECT_EQ(summary.items[0].n, 0);
  EXPECT_EQ(summary.items[1].item.text, form.items[1].text);
  EXPECT_EQ(summary.items[1].n, 1);
  EXPECT_TRUE(summary.items[4].is_retired);
  EXPECT_EQ(summary.items[4].item.text, "Training with the simulator is useful for me.");
  EXPECT_EQ(summary.items[4].mean, 1.0);
}

TEST_P(Questionnaires, AreRefusedWithoutItemsOrText) {
  Form form = default_form();
  form.items.clear();
  EXPECT_FALSE(add_form(*repository_, form, kNow));
  form = default_form();
  form.items[1].text = " \n ";
  EXPECT_FALSE(add_form(*repository_, form, kNow));
  form = default_form();
  form.title.clear();
  EXPECT_FALSE(add_form(*repository_, form, kNow));
  form = default_form();
  form.items.resize(kMaxItems + 1, form.items[0]);
  EXPECT_FALSE(add_form(*repository_, form, kNow));
  EXPECT_TRUE(list_forms(*repository_)->empty());
}

TEST_P(Questionnaires, AreDeletedWithTheirAnswers) {
  const Form form = add_default();
  ASSERT_TRUE(answer(form, {1, 1, 1, 1}));
  ASSERT_TRUE(delete_form(*repository_, form.id));
  EXPECT_FALSE(delete_form(*repository_, form.id));
  EXPECT_FALSE(summarise_form(*repository_, form.id)->has_value());
}

}  // namespace
}  // namespace trocar::results
