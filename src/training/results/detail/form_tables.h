#pragma once

#include <soci/soci.h>

#include <optional>
#include <string>
#include <vector>

#include "results/questionnaires.h"

namespace trocar::results::detail {

// Rows of the tables of questionnaires, within a transaction. The functions throw soci::soci_error.

/// `condition` has the one parameter :k. With the items that are not retired.
std::optional<Form> read_form(soci::session& session, const std::string& condition, const std::string& key);
std::vector<Form> read_forms(soci::session& session);
void insert_form(soci::session& session, const Form& form);
void update_form(soci::session& session, const Form& form);
void insert_item(soci::session& session, const std::string& form_id, const Item& item, int position);
void update_item(soci::session& session, const Item& item, int position);
bool has_answers(soci::session& session, const std::string& item_id);
/// Removes an item without answers, retires one with answers.
void remove_or_retire(soci::session& session, const std::string& item_id);
/// False if there is a response of this id already.
bool insert_response(soci::session& session, const std::string& id, const std::string& form_id,
                     const std::string& person_id, Seconds now);
void insert_answer(soci::session& session, const std::string& response_id, const std::string& item_id,
                   const Answer& answer);

/// All items, retired ones last.
std::vector<ItemSummary> summarise_items(soci::session& session, const std::string& form_id);
std::string write_answers(soci::session& session, const std::string& form_id);

}  // namespace trocar::results::detail
