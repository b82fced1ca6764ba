// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What VTK says when something is wrong.
 */
#ifndef Messages_h
#define Messages_h

#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkSmartPointer.h"
#include "vtkStringOutputWindow.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// Collects the messages that VTK prints while it lives.
class Messages
{
public:
  Messages()
    : Before(vtkOutputWindow::GetInstance())
  {
    vtkOutputWindow::SetInstance(this->Window);
  }
  ~Messages() { vtkOutputWindow::SetInstance(this->Before); }

  std::string GetText() const { return this->Window->GetOutput(); }
  int Count(const std::string& what) const
  {
    int count = 0;
    const std::string text = this->GetText();
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    {
      ++count;
    }
    return count;
  }
  /// One message, which has all of these words.
  void ExpectOne(const std::vector<std::string>& words) const
  {
    EXPECT_EQ(this->Count("ERROR:") + this->Count("Warning:"), 1) << this->GetText();
    for (const std::string& word : words)
    {
      EXPECT_NE(this->GetText().find(word), std::string::npos)
        << "no '" << word << "' in: " << this->GetText();
    }
  }

private:
  vtkSmartPointer<vtkOutputWindow> Before;
  vtkNew<vtkStringOutputWindow> Window;
};

#endif
