// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Tells, if the program crashes, how to repeat what it was trying.
 */
#ifndef SeedOnCrash_h
#define SeedOnCrash_h

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <string>

class SeedOnCrash
{
public:
  /// The command that repeats what is tried next.
  static void Set(const std::string& command)
  {
    const std::string text = "To repeat: " + command + "\n";
    const std::size_t size = std::min(text.size(), Command.size() - 1);
    std::copy_n(text.begin(), size, Command.begin());
    Command[size] = '\0';
    for (const int signal : { SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL })
    {
      std::signal(signal, Tell);
    }
  }

private:
  static void Tell(int signal)
  {
    std::signal(signal, SIG_DFL);
    if (write(STDERR_FILENO, Command.data(), std::strlen(Command.data())) >= 0)
    {
      std::raise(signal);
    }
  }

  inline static std::array<char, 200> Command{};
};

#endif
