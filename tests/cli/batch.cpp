// `trueshade batch`: jobs with dependencies, what a failing one does to others, and what is run again.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/cli/refused.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using nlohmann::json;

json job(const std::string& name, const std::vector<std::string>& run, const std::vector<std::string>& after = {}) {
  json made{{"name", name}, {"run", run}};
  if (!after.empty()) made["after"] = after;
  return made;
}

std::vector<std::string> drawing(const std::string& scene, const std::string& output) {
  return {"render", scene, "--size", "16x16", "--hash", "-o", output};
}

/// A folder with a file of jobs.
struct Batch {
  ScratchFolder folder;

  void write(const std::vector<json>& jobs) const { folder.write("jobs.json", json{{"jobs", jobs}}.dump()); }

  Outcome run(std::vector<std::string> options = {}, const std::string& setup = "true") const {
    options.insert(options.begin(), {"batch", "jobs.json"});
    return run_command(options, folder.path(""), setup);
  }

  /// States and reasons by name.
  struct Row {
    std::string state, reason;
  };
  std::map<std::string, Row> rows(std::vector<std::string> options = {}) const {
    options.insert(options.end(), {"--json", "-"});
    const Outcome outcome = run(options);
    INFO(outcome.err);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
    std::map<std::string, Row> rows;
    const json document = json::parse(outcome.out);
    bool all_passed = true;
    for (const json& row : document["jobs"]) {
      rows[row["name"]] = {row["state"], row["reason"]};
      all_passed = all_passed && (row["state"] == "passed" || row["state"] == "unchanged");
    }
    CHECK(document["passed"] == all_passed);
    CHECK(outcome.exit_code == (all_passed ? 0 : 1));
    return rows;
  }

  /// `a:passed b:unchanged`, in the order of names.
  std::string states(const std::vector<std::string>& options = {}) const {
    std::string text;
    for (const auto& [name, row] : rows(options)) text += (text.empty() ? "" : " ") + name + ':' + row.state;
    return text;
  }
};

TEST_CASE("Jobs run after those that they are after, and one that fails ends no other but those after it") {
  const Batch batch;
  batch.write({job("compare", {"compare", "one.png", "two.png"}, {"draw-*"}),
               job("draw-one", drawing("builtin:cornell", "one.png")),
               job("draw-two", drawing("builtin:cornell", "two.png")), job("missing", {"info", "nothing.json"}),
               job("next", {"info", "builtin:cornell"}, {"missing"}),
               job("last", {"info", "builtin:cornell"}, {"draw-one", "next"})});
  const auto rows = batch.rows({"--jobs", "2"});
  CHECK(rows.at("compare").state == "passed");
  CHECK(rows.at("draw-one").state == "passed");
  CHECK(rows.at("draw-two").state == "passed");
  CHECK(rows.at("missing").state == "failed");
  CHECK(rows.at("missing").reason == "nothing.json: No such file or directory (a file that exists and can be read)");
  CHECK(rows.at("next").reason == "it is after missing, which failed");
  CHECK(rows.at("last").reason == "it is after next, which was skipped");
  CHECK(batch.states({"--only", "compare", "--resume"}) == "compare:unchanged draw-one:unchanged draw-two:unchanged");
  CHECK(batch.states({"--only", "next"}) == "missing:failed next:skipped");
  check_refused(batch.run({"--only", "nobody"}), 2, "--only");
}

TEST_CASE("A job passes by its exit code and its hash, and a reason says how it did not") {
  const Batch batch;
  json right = job("right", drawing("builtin:cornell", "a.png")),
       wrong = job("wrong", drawing("builtin:sphere", "b.png")), none = job("none", {"info", "builtin:cornell"}),
       refused = job("refused", {"info", "nothing.json"}),
       frames = job("frames", {"render", "builtin:cornell", "--size", "8x8", "--hash", "--frames", "0-1"}),
       other = refused, early = wrong;
  batch.write({right});
  const std::string table = batch.run().out;
  const json document = json::parse(batch.run({"--json", "-"}).out);
  const std::string hash = document["jobs"][0]["hashes"][0];
  CHECK(table.find("passed ") != std::string::npos);
  CHECK(table.find(hash.substr(7, 12)) != std::string::npos);
  CHECK(document["jobs"][0]["wrote"][0]["path"] == "a.png");
  right["expect"] = {{"hash", hash}};
  wrong["expect"] = {{"hash", hash}};
  none["expect"] = {{"hash", hash}};
  frames["expect"] = {{"hash", {hash}}};
  refused["expect"] = {{"exit", 5}};
  other["name"] = "other", other["expect"] = {{"exit", 3}};
  batch.write({right, wrong, none, frames, refused, other});
  const auto rows = batch.rows();
  CHECK(rows.at("right").state == "passed");
  CHECK(rows.at("wrong").reason.ends_with(", and " + hash + " is expected"));
  CHECK(rows.at("none").reason == "it prints no hash, and one is expected (add --hash to its run)");
  CHECK(rows.at("frames").reason == "it prints 2 hashes, and 1 is expected");
  CHECK(rows.at("refused").state == "passed");
  CHECK(rows.at("other").reason.starts_with("exit code 5, and 3 is expected: nothing.json: "));
}

TEST_CASE("A crash and a timeout fail a job alone") {
  const Batch batch;
  json slow =
           job("slow", {"render", "builtin:city,lights=100000", "--size", "12000x12000", "--threads", "1", "--hash"}),
       crash = job("crash", drawing("builtin:cornell", "c.png"));
  slow["timeout"] = 0.3;
  batch.write({slow, crash, job("good", drawing("builtin:cornell", "a.png"))});
  // The test library ends the process that writes c.png by a signal, as a crash would.
  const Outcome outcome = batch.run({"--json", "-", "--jobs", "3"}, "export LD_PRELOAD=" CRASH_AT);
  const json jobs = json::parse(outcome.out)["jobs"];
  CHECK(outcome.exit_code == 1);
  CHECK(jobs[0]["reason"] == "it took longer than its timeout of 0.3 s");
  CHECK(jobs[0]["seconds"] < 10.0);
  CHECK(jobs[1]["reason"] == "ended by signal 11 (Segmentation fault)");
  CHECK(jobs[2]["state"] == "passed");
}

TEST_CASE("Jobs are not told that the batch was started under MPI") {
  const Batch batch;
  batch.write({job("a", {"info", "builtin:cornell"})});
  // The test library ends jobs that are told.
  const Outcome outcome =
      batch.run({"-q"}, "export OMPI_COMM_WORLD_SIZE=4 PMIX_RANK=1 PMI_SIZE=4 PRTE_X=1 && export LD_PRELOAD=" CRASH_AT);
  CHECK(outcome.out == "verdict     the job passed\n");
}

TEST_CASE("A list of words makes a job for each choice of them") {
  const Batch batch;
  json draw = job("{scene}-{strategy}", {"render", "builtin:{scene}", "--size", "8x8", "--strategy", "{strategy}",
                                         "--hash", "-o", "{scene}-{strategy}.png"});
  draw["for"] = {{"scene", {"cornell", "sphere"}}, {"strategy", {"deferred-loop", "forward-loop"}}};
  json same = job("same-{scene}", {"compare", "{scene}-deferred-loop.png", "{scene}-forward-loop.png"}, {"{scene}-*"});
  same["for"] = {{"scene", {"cornell", "sphere"}}};
  batch.write({draw, same});
  CHECK(batch.states() ==
        "cornell-deferred-loop:passed cornell-forward-loop:passed same-cornell:passed same-sphere:passed "
        "sphere-deferred-loop:passed sphere-forward-loop:passed");
}

TEST_CASE("A resumed batch leaves out what passed, and runs again what has changed, and what reads that") {
  const Batch batch;
  const std::string model =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 ";
  batch.folder.write("model.ply", model + "0\n3 0 1 2\n");
  batch.folder.write("copy.png", "");
  const json draw = job("draw", drawing("model.ply", "a.png")), info = job("info", {"info", "a.png"}, {"draw"});
  json other = job("other", drawing("builtin:cornell", "b.png"));
  batch.write({draw, info, other});
  CHECK(batch.states() == "draw:passed info:passed other:passed");
  CHECK(batch.states({"--resume"}) == "draw:unchanged info:unchanged other:unchanged");
  CHECK(batch.states({"--resume", "--jobs", "1", "--threads", "1"}) == "draw:unchanged info:unchanged other:unchanged");

  batch.folder.write("model.ply", model + "0.5\n3 0 1 2\n");  // an input, and what is made of it
  CHECK(batch.states({"--resume"}) == "draw:passed info:passed other:unchanged");
  batch.folder.write("model.ply", model + "0.5\n3 0 1 2\n\n");  // an input, and nothing else comes of it
  const std::string pixels = contents(batch.folder.path("a.png"));
  CHECK(batch.states({"--resume"}) == "draw:passed info:unchanged other:unchanged");
  CHECK(contents(batch.folder.path("a.png")) == pixels);

  std::filesystem::remove(batch.folder.path("a.png"));  // an output
  CHECK(batch.states({"--resume"}) == "draw:passed info:unchanged other:unchanged");
  batch.folder.write("b.png", "torn");
  CHECK(batch.states({"--resume"}) == "draw:unchanged info:unchanged other:passed");

  other["run"].push_back("--stats");  // the call
  batch.write({draw, info, other});
  CHECK(batch.states({"--resume"}) == "draw:unchanged info:unchanged other:passed");
  other["expect"] = {{"exit", 3}};
  batch.write({draw, info, other});
  CHECK(batch.states({"--resume"}) == "draw:unchanged info:unchanged other:failed");
  CHECK(batch.states({"--resume"}) == "draw:unchanged info:unchanged other:failed");

  std::string state = contents(batch.folder.path("jobs.json.state"));  // the program
  for (size_t at; (at = state.find("\\\"trueshade ")) != std::string::npos;) state.replace(at, 12, "\\\"another ");
  batch.folder.write("jobs.json.state", state);
  CHECK(batch.states({"--resume"}) == "draw:passed info:passed other:failed");
  CHECK(batch.states() == "draw:passed info:passed other:failed");  // without --resume all runs
}

TEST_CASE("A resumed batch sees a change of a file that a scene names, and of the files of a folder") {
  const Batch batch;
  const std::string tests = TRUESHADE_SOURCE_DIR "/tests/docs/files/";
  for (const auto& entry : std::filesystem::directory_iterator(tests))
    std::filesystem::copy(entry.path(), batch.folder.path(entry.path().filename().string()),
                          std::filesystem::copy_options::recursive);
  batch.write({job("draw", drawing("scene.json", "a.png")), job("reference", drawing("builtin:cornell", "one/a.png")),
               job("test", drawing("builtin:cornell", "two/a.png")),
               job("folders", {"compare", "one", "two"}, {"reference", "test"})});
  for (const char* folder : {"one", "two"}) std::filesystem::create_directory(batch.folder.path(folder));
  CHECK(batch.states() == "draw:passed folders:passed reference:passed test:passed");
  CHECK(batch.states({"--resume"}) == "draw:unchanged folders:unchanged reference:unchanged test:unchanged");
  std::string model = contents(batch.folder.path("model.ply"));
  batch.folder.write("model.ply", model + "\n");
  CHECK(batch.states({"--resume"}) == "draw:passed folders:unchanged reference:unchanged test:unchanged");
  for (const char* copy : {"one/b.png", "two/b.png"})
    std::filesystem::copy(batch.folder.path("one/a.png"), batch.folder.path(copy));
  CHECK(batch.states({"--resume"}) == "draw:unchanged folders:passed reference:unchanged test:unchanged");
}

TEST_CASE("A file of jobs that is wrong is refused in one line that names the place") {
  const Batch batch;
  const auto refused = [&batch](const std::string& text, const std::string& about) {
    INFO(text);
    batch.folder.write("jobs.json", text);
    check_refused(batch.run(), 3, about);
    CHECK_FALSE(std::filesystem::exists(batch.folder.path("jobs.json.state")));
  };
  const auto list = [](const std::string& jobs) { return R"({"jobs":[)" + jobs + "]}"; };
  const std::string a = R"({"name":"a","run":["info","builtin:red"]})";
  refused("", "jobs.json");
  refused("{\"jobs\":", "line 1");
  refused(std::string(100000, '['), "jobs.json");
  refused("{}", "jobs");
  refused(list(""), "/jobs: ");
  refused(list(R"({"name":"a","runs":["info"]})"), "/jobs/0/runs: this key is unknown (did you mean run?");
  refused(list(R"({"name":"a","run":[]})"), "/jobs/0/run: ");
  refused(list(R"({"name":"a","run":["info",7]})"), "/jobs/0/run/1: found 7");
  refused(list(R"({"name":"","run":["info","builtin:red"]})"), "/jobs/0/name: ");
  refused(list(R"({"name":"a*","run":["info","builtin:red"]})"), "/jobs/0/name: ");
  refused(list(a + ',' + a), "/jobs/1/name: two jobs have the name 'a'");
  refused(list(R"({"name":"a","run":["bench"]})"), "/jobs/0/run/0: 'bench' is no command that a job may be");
  refused(list(R"({"name":"a","run":["rendr"]})"), "did you mean render?");
  refused(list(R"({"name":"a","run":["info","builtin:red","--sizes","1x1"]})"),
          "/jobs/0/run: --sizes: there is no such option (did you mean --size?");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"after":["b"]})"), "/jobs/0/after/0: there is no job 'b'");
  refused(list(a + R"(,{"name":"city-hall","run":["info","builtin:red"],"after":["city-hal"]})"),
          "(did you mean city-hall?");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"after":["a"]})"), "the job is after itself");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"timeout":0})"), "/jobs/0/timeout: found 0");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"expect":{"exit":256}})"), "/jobs/0/expect/exit: ");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"expect":{"hash":"sha256:12"}})"), "is no hash");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"for":{"x":[]}})"), "/jobs/0/for/x: ");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"for":{"x":["1","2"]}})"), "every word of `for` in braces");
  refused(list(R"({"name":"a","run":["info","builtin:red"],"for":["x"]})"), "/jobs/0/for: this is no object");
  refused(list(R"({"name":"a","run":["render","builtin:red","-o","x.png"]},)"
               R"({"name":"b","run":["render","builtin:red","-o","./x.png"]})"),
          "/jobs/1/run: the job 'b' writes ./x.png, as the job 'a' does");
  const std::string many = R"(["1","2","3","4","5","6","7","8","9","0"])";
  batch.folder.write("jobs.json",
                     list(R"({"name":"{a}{b}{c}{d}{e}","run":["info","builtin:red"],"for":{"a":)" + many + R"(,"b":)" +
                          many + R"(,"c":)" + many + R"(,"d":)" + many + R"(,"e":)" + many + "}}"));
  check_refused(batch.run(), 4, "/jobs/0/for: this makes more jobs than the limit");
  std::string circle;
  for (const char* names : {"a after b", "b after c", "c after a", "d after a"})
    circle += std::string(circle.empty() ? "" : ",") + R"({"name":")" + names[0] +
              R"(","run":["info","builtin:red"],"after":[")" + names[8] + "\"]}";
  refused(list(circle), "jobs wait for each other: a after b after c after a");
}

TEST_CASE("No result of a batch takes the place of its jobs, of another result or of a picture") {
  const Batch batch;
  batch.write({job("a", {"info", "builtin:red"})});
  const std::string jobs = contents(batch.folder.path("jobs.json"));
  std::filesystem::create_symlink("jobs.json", batch.folder.path("link.json"));
  for (const auto& [options, about] : std::vector<std::pair<Arguments, const char*>>{
           {{"--state", "jobs.json"}, "--state: "},
           {{"--json", "./jobs.json"}, "--json: "},
           {{"--json", "link.json"}, "--json: 'link.json' is the file of jobs"},
           {{"--json", "r.json", "--state", "r.json"}, "--json: 'r.json' is named twice"},
           {{"--json", "a.png"}, "--json: 'a.png' does not end like JSON"},
           {{"--state", "a.png"}, "--state: "},
           {{"--json", ""}, "--json: "}})
    check_refused(run_command(with({"batch", "jobs.json"}, options), batch.folder.path("")), 2, about);
  CHECK(contents(batch.folder.path("jobs.json")) == jobs);
}

TEST_CASE("The journal of a batch is not opened through a link") {
  const Batch batch;
  batch.write({job("a", {"info", "builtin:red"})});
  batch.folder.write("elsewhere/mine", "mine");
  std::filesystem::create_symlink("elsewhere/mine", batch.folder.path("jobs.json.state"));
  check_refused(batch.run(), 5, "jobs.json.state: cannot open it");
  std::ifstream file(batch.folder.path("elsewhere/mine"));
  std::string text;
  CHECK((std::getline(file, text) && text == "mine"));
}

TEST_CASE("JUnit and the page say what the table says, and a full disk takes no result") {
  const Batch batch;
  batch.write({job("draw <a>", drawing("builtin:cornell", "a.png")), job("gone", {"info", "gone&.json"}),
               job("then", {"info", "builtin:red"}, {"gone"})});
  const Outcome outcome = batch.run({"--junit", "r.xml", "--report", "r.html", "--json", "r.json", "--jobs", "1"});
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.starts_with("verdict     1 of 3 jobs passed, 1 failed, 1 skipped\n\noutcome "));
  for (const char* wrote : {"wrote r.xml (JUnit, ", "wrote r.html (HTML report, ", "wrote r.json (JSON, "})
    CHECK(outcome.out.find(wrote) != std::string::npos);
  const std::string junit = contents(batch.folder.path("r.xml")), page = contents(batch.folder.path("r.html"));
  CHECK(junit.find(R"(tests="3" failures="1" skipped="1")") != std::string::npos);
  CHECK(junit.find(R"(name="draw &lt;a&gt;")") != std::string::npos);
  CHECK(junit.find(R"(<failure type="failed" message="gone&amp;.json: No such file)") != std::string::npos);
  CHECK(junit.find(R"(<skipped message="it is after gone, which failed"/>)") != std::string::npos);
  CHECK(page.find("draw &lt;a&gt;") != std::string::npos);
  CHECK(page.find("src=\"data:image/png;base64,") != std::string::npos);
  CHECK(page.ends_with("</html>\n"));
  CHECK(batch.run({"-q"}).out == "verdict     1 of 3 jobs passed, 1 failed, 1 skipped\n");
  const Outcome full = batch.run({"--report", "/dev/full", "-q"});
  CHECK(full.exit_code == 2);  // its name does not end in .html
  std::filesystem::create_symlink("/dev/full", batch.folder.path("full.html"));
  const Outcome no_space = batch.run({"--resume", "--report", "full.html"});
  CHECK(no_space.exit_code == 5);
  CHECK(no_space.err.find("full.html: cannot write: No space left on device") != std::string::npos);
  CHECK(batch.states({"--resume"}) == "draw <a>:unchanged gone:failed then:skipped");
  check_refused(batch.run({"--state", "/dev/full"}), 3, "this is no regular file");
  check_refused(batch.run({"--state", "nowhere/s"}), 5, "nowhere/s: cannot open it");
}

TEST_CASE("An error that ends a batch is in its JUnit, in place of what an earlier run wrote there") {
  const Batch batch;
  batch.write({job("a", drawing("builtin:cornell", "a.png"))});
  REQUIRE(batch.run({"--junit", "r.xml"}).exit_code == 0);
  batch.folder.write("jobs.json", R"({"jobs": [{"name": "a", "runs": ["info", "builtin:cornell"]}]})");
  CHECK(batch.run({"--junit", "r.xml"}).exit_code == 3);
  const std::string junit = contents(batch.folder.path("r.xml"));
  CHECK(junit.find(R"(failures="0" errors="1")") != std::string::npos);
  CHECK(junit.find("/jobs/0") != std::string::npos);
}

/// Starts a batch in a folder, silent.
pid_t start_batch(const Batch& batch) {
  const std::string place = batch.folder.path("");
  const pid_t process = fork();
  if (process != 0) return process;
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
  if (chdir(place.c_str()) == 0)
    execl(TRUESHADE_COMMAND, TRUESHADE_COMMAND, "batch", "jobs.json", "--resume", "--jobs", "2",
          static_cast<char*>(nullptr));
  _exit(127);
}

int end_of(pid_t process) {
  int status = 0;
  REQUIRE(waitpid(process, &status, 0) == process);
  return status;
}

/// Whether a process works in the folder, or below.
bool works_in(const std::string& folder) {
  const std::string place = std::filesystem::canonical(folder).string();
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::error_code gone;
    const std::string cwd = std::filesystem::read_symlink(entry.path() / "cwd", gone).string();
    if (!gone && cwd.starts_with(place)) return true;
  }
  return false;
}

/// Whether that holds within a second, in which a job that is not ended goes on.
bool soon(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  do {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

/// Ends runs at random times until one gets to its end: no process is left, pictures are whole, and the table is that
/// of a run that nobody ended.
void end_at_random(int kills, int signal) {
  const Batch whole, batch;
  std::vector<json> jobs;
  for (int i = 0; i < 8; ++i)
    jobs.push_back(job("draw" + std::to_string(i),
                       {"render", "builtin:cornell", "--size", "64x" + std::to_string(40 + i), "--hash", "-o",
                        std::to_string(i) + ".png"},
                       i < 2 ? std::vector<std::string>{} : std::vector{"draw" + std::to_string(i - 2)}));
  jobs.push_back(job("bad", {"info", "nothing.json"}));
  whole.write(jobs), batch.write(jobs);
  const auto begin = std::chrono::steady_clock::now();
  const std::map<std::string, Batch::Row> expected = whole.rows({"--jobs", "2"});
  const auto longest = std::chrono::steady_clock::now() - begin;
  std::mt19937 random(7);
  int killed = 0, noted = 0;
  for (int run = 0; killed < kills && run < 30 * kills; ++run) {
    if (run % 3 == 2) std::filesystem::remove(batch.folder.path("jobs.json.state"));  // so that there is work to do
    const pid_t process = start_batch(batch);
    std::this_thread::sleep_for(longest * (random() % 1000) / 1000);
    kill(process, signal);
    const int status = end_of(process);
    killed += WIFSIGNALED(status) && WTERMSIG(status) == signal ? 1 : 0;
    CHECK(soon([&batch] { return !works_in(batch.folder.path("")); }));
    noted += contents(batch.folder.path("jobs.json.state")).empty() ? 0 : 1;
    for (const std::string& name : batch.folder.entries())
      if (name.ends_with(".png")) CHECK(contents(batch.folder.path(name)) == contents(whole.folder.path(name)));
  }
  CHECK(killed == kills);
  CHECK(noted > 0);
  const auto rows = batch.rows({"--resume"});
  REQUIRE(rows.size() == expected.size());
  for (const auto& [name, row] : expected) {
    INFO(name);
    CHECK(rows.at(name).reason == row.reason);
    CHECK((rows.at(name).state == row.state || (row.state == "passed" && rows.at(name).state == "unchanged")));
    if (name != "bad")
      CHECK(contents(batch.folder.path(name.substr(4) + ".png")) ==
            contents(whole.folder.path(name.substr(4) + ".png")));
  }
}

TEST_CASE("Jobs end with their batch, however long they would take, and an ignored hang-up ends neither") {
  for (const int signal : {SIGKILL, SIGTERM}) {
    const Batch batch;
    batch.write(
        {job("slow", {"render", "builtin:city,lights=100000", "--size", "12000x12000", "--threads", "1", "--hash"})});
    const pid_t process = start_batch(batch);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    CHECK(works_in(batch.folder.path("")));
    kill(process, signal);
    CHECK(WTERMSIG(end_of(process)) == signal);
    CHECK(soon([&batch] { return !works_in(batch.folder.path("")); }));
  }
  const Batch batch;
  batch.write({job("a", drawing("builtin:cornell", "a.png"))});
  std::signal(SIGHUP, SIG_IGN);
  const pid_t process = start_batch(batch);
  std::signal(SIGHUP, SIG_DFL);
  for (int i = 0; i < 20; ++i) {
    kill(process, SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  CHECK(end_of(process) == 0);
}

TEST_CASE("A batch that is killed leaves no process, tears nothing, and is resumed") { end_at_random(4, SIGKILL); }
TEST_CASE("A batch that is interrupted ends its jobs, and is resumed") { end_at_random(3, SIGINT); }
TEST_CASE("A batch that is killed 50 times is resumed", "[long]") { end_at_random(50, SIGKILL); }

TEST_CASE("Two runs do not share a journal, and a torn line of it is passed over") {
  const Batch batch;
  batch.write({job("a", drawing("builtin:cornell", "a.png")), job("b", drawing("builtin:cornell", "b.png"))});
  CHECK(batch.states() == "a:passed b:passed");
  const std::string state = contents(batch.folder.path("jobs.json.state"));
  batch.folder.write("jobs.json.state", state.substr(0, state.size() - 40));
  const std::string states = batch.states({"--resume"});
  CHECK((states == "a:passed b:unchanged" || states == "a:unchanged b:passed"));
  CHECK(batch.states({"--resume"}) == "a:unchanged b:unchanged");
  check_refused(batch.run({"--resume"}, "exec 9<jobs.json.state; flock 9"), 3, "another run is at work with it");
}

}  // namespace
}  // namespace trueshade
