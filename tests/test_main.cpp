// Runs the tests of a program in the user's locale of numbers: ./test chooses one with decimal commas.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>

#include "core/testing/run_all_tests.h"

int main(int argc, char** argv) {
  const char* wanted = std::getenv("LC_NUMERIC");
  if (std::setlocale(LC_NUMERIC, "") == nullptr && wanted != nullptr) {
    std::fprintf(stderr, "error: the locale %s of LC_NUMERIC is not there\n", wanted);
    return 1;
  }
  testing::InitGoogleTest(&argc, argv);
  return trocar::testing::run_all_tests();
}
