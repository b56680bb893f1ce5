#pragma once

#include <array>
#include <string_view>

namespace trocar::signing {

/// Words of the passwords that people choose most, lower case, of letters alone; written for this project.
inline constexpr auto kCommonWords = std::to_array<std::string_view>({
    "abc",       "abcd",      "access",     "admin",    "administrator", "alpha",     "amanda",     "america",
    "andrew",    "angel",     "apple",      "arsenal",  "ashley",        "autumn",    "baby",       "bailey",
    "banana",    "barcelona", "baseball",   "basket",   "batman",        "biopsy",    "blink",      "blue",
    "boss",      "buster",    "butterfly",  "changeme", "charlie",       "cheese",    "chelsea",    "chocolate",
    "clinic",    "computer",  "cookie",     "daniel",   "default",       "demo",      "department", "doctor",
    "dragon",    "dream",     "family",     "flower",   "foot",          "football",  "forever",    "freedom",
    "friday",    "friends",   "fuck",       "ginger",   "girl",          "google",    "guest",      "hannah",
    "harley",    "hello",     "hockey",     "hospital", "hunter",        "iloveyou",  "instructor", "internet",
    "jennifer",  "jessica",   "jesus",      "jordan",   "joshua",        "justin",    "killer",     "letmein",
    "liverpool", "login",     "lord",       "love",     "lovely",        "maggie",    "master",     "matrix",
    "matthew",   "medicine",  "merlin",     "michael",  "michelle",      "monday",    "money",      "monkey",
    "mother",    "mustang",   "my",         "needle",   "nicole",        "ninja",     "nurse",      "orange",
    "pass",      "passcode",  "passphrase", "passwd",   "password",      "patient",   "pepper",     "pokemon",
    "princess",  "private",   "purple",     "ranger",   "red",           "robert",    "root",       "samsung",
    "secret",    "secure",    "security",   "server",   "shadow",        "simulator", "snoopy",     "soccer",
    "spring",    "starwars",  "student",    "summer",   "sunday",        "sunshine",  "super",      "superman",
    "sweet",     "system",    "teacher",    "temp",     "test",          "testing",   "the",        "thomas",
    "thunder",   "tigger",    "trainee",    "trainer",  "training",      "trocar",    "trustno",    "user",
    "welcome",   "whatever",  "winter",     "you",      "your",
});

/// Rows of keys, and the alphabet: five or more neighbours in either direction are a row.
inline constexpr auto kKeyRows = std::to_array<std::string_view>({
    "abcdefghijklmnopqrstuvwxyz",
    "01234567890123456789",
    "qwertyuiop",
    "asdfghjkl",
    "zxcvbnm",
    "qwertzuiop",
    "yxcvbnm",
    "azertyuiop",
    "qsdfghjklm",
    "wxcvbn",
    "1qaz2wsx3edc4rfv5tgb6yhn7ujm",
    "qazwsxedcrfvtgbyhnujm",
    "1q2w3e4r5t6y7u8i9o0p",
});

}  // namespace trocar::signing
