#pragma once
// Checks of several options of a command against each other. They come after each row of the command's table has read
// its own value.
#include <string>
#include <vector>

#include "cli/options.h"

namespace trueshade {

/// One file cannot hold two documents, and who wants two has mistyped a name: Error(usage).
void check_named_once(const std::string& option, std::vector<std::string> files);

/// The options of a command, with what follows from several of them. Error(usage) names the option.
RenderOptions finished(RenderOptions options);
InfoOptions finished(InfoOptions options);
GlslFilesOptions finished(GlslFilesOptions options);
ExportOptions finished(ExportOptions options);
ValidationOptions finished(ValidationOptions options);
ProbeOptions finished(ProbeOptions options);
ShadeOptions finished(ShadeOptions options);
ExplainOptions finished(ExplainOptions options);
BenchOptions finished(BenchOptions options);
ViewOptions finished(ViewOptions options);
CompareOptions finished(CompareOptions options);
BatchOptions finished(BatchOptions options);

}  // namespace trueshade
