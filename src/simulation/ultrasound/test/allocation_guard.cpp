#include "core/testing/allocation_guard.inc.h"  // once in this test program
