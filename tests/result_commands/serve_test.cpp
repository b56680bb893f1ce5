// trocar serve: accounts, refusals, start and end.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

/// Runs `trocar ARGUMENTS` with this line as standard input.
Outcome with_input(const std::string& line, const std::string& arguments) {
  return trocar(arguments, "printf '%s\\n' '" + line + "' |");
}

TEST(Serve, AccountsAreAddedChangedAndRemoved) {
  const TemporaryFolder folder;
  const std::string db = " --db '" + folder / "results.sqlite" + "'";
  EXPECT_EQ(trocar("serve account list" + db).out, "");
  const Outcome added =
      with_input("grinding copper lids", "serve account add 'Dr. Weber' --role admin --password-stdin" + db);
  EXPECT_EQ(added.exit_status, 0) << added.err;
  EXPECT_EQ(added.out, "Dr. Weber may log in as admin\n");
  EXPECT_EQ(trocar("serve account list" + db).out, "admin      Dr. Weber\n");
  expect_refused(with_input("grinding copper lids", "serve account add 'dr. weber' --password-stdin" + db), 2,
                 "is taken");
  expect_refused(with_input("short", "serve account add x --password-stdin" + db), 2, "too short");
  expect_refused(with_input("passwordpassword", "serve account add x --password-stdin" + db), 2, "tried first");
  expect_refused(with_input("grinding copper lids", "serve account add x --role root --password-stdin" + db), 2,
                 "no such role");
  for (const char* name : {"a/b", "..", "."})
    expect_refused(
        with_input("grinding copper lids", std::string("serve account add '") + name + "' --password-stdin" + db), 2,
        "an address cannot contain the name");
  expect_refused(trocar("serve account add x < /dev/null" + db), 2, "--password-stdin");
  EXPECT_EQ(with_input("seven quiet otters", "serve account password 'Dr. Weber' --password-stdin" + db).exit_status,
            0);
  expect_refused(trocar("serve account remove 'Dr. Weber'" + db), 2, "last account");
  expect_refused(trocar("serve account remove nobody" + db), 2, "no such account");
  EXPECT_EQ(read_text(folder / "results.sqlite").find("otters"), std::string::npos) << "only a hash is stored";
}

TEST(Serve, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const std::string db = " --db '" + folder / "results.sqlite" + "'";
  expect_refused(trocar("serve --listen 0.0.0.0:0" + db), 2, "without encryption");
  expect_refused(trocar("serve --listen '[::]:0'" + db), 2, "without encryption");
  expect_refused(trocar("serve --listen example.org:80" + db), 2, "not an address to listen on");
  expect_refused(trocar("serve --listen 127.0.0.1:99999" + db), 2, "not a port");
  expect_refused(trocar("serve --key key.pem" + db), 2, "needs a certificate");
  expect_refused(trocar("serve --certificate nothing.pem --key nothing.pem" + db), 1, "nothing.pem");
  std::ofstream(folder / "text.sqlite") << "this is no database, but a text that is long enough to be read as a header";
  expect_refused(trocar("serve --listen 127.0.0.1:0 --db '" + folder / "text.sqlite" + "'"), 1, "text.sqlite");
}

TEST(Serve, PrintsItsAddressAndEndsBySignal) {
  const TemporaryFolder folder;
  const Outcome served = run_shell(
      "(cd '" + folder.path().string() +
      "'; \"$TROCAR_BIN_DIR\"/trocar serve --db results.sqlite --listen 127.0.0.1:0 > out & "
      "until grep -q http out; do kill -0 $! || exit 3; done; kill -TERM $!; wait $!; s=$?; cat out; exit $s)");
  EXPECT_EQ(served.exit_status, 0) << served.err;
  EXPECT_TRUE(served.out.starts_with("http://127.0.0.1:")) << served.out;
  EXPECT_NE(served.err.find("there is no account yet"), std::string::npos) << served.err;
}

}  // namespace
}  // namespace trocar::cli_test
