#pragma once

// As Debian's library is compiled: the option changes the layout of its classes.
#define CPPHTTPLIB_OPENSSL_SUPPORT
#include <httplib.h>
