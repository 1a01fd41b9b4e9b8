#pragma once

#include <iosfwd>
#include <string>

namespace roundel::bench {

// Shows the detector `pictures` of every kind of distractor and writes how many markers it saw, as
// a table for readers. `folder`, if not empty, takes the first few pictures with a false marker, as
// PGM.
void write_false_positives(std::ostream& markdown, int pictures, const std::string& folder);

}  // namespace roundel::bench
