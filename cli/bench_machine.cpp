// What bench says of the machine, and of how busy it was.
#include <utility>

#include "cli/bench.h"
#include "cli/json_text.h"
#include "cli/version.h"

namespace trueshade {
namespace {

std::string memory_text(double mib) { return formatted(mib / 1024, mib < 10240 ? "%.1f GiB" : "%.0f GiB"); }

std::string cache_text(const Cache& cache) {
  const std::string kind = cache.type == "Data" ? "d" : cache.type == "Instruction" ? "i" : "";
  return 'L' + std::to_string(cache.level) + kind + ' ' +
         (cache.kib % 1024 == 0 ? std::to_string(cache.kib / 1024) + " MiB" : std::to_string(cache.kib) + " KiB") +
         (cache.count > 1 ? " x " + std::to_string(cache.count) : "");
}

/// What follows `Mesa `, up to a space; empty of other drivers.
std::string mesa_version(const std::string& opengl) {
  const size_t at = opengl.find("Mesa ");
  const size_t number = opengl.find_first_of("0123456789", at == std::string::npos ? opengl.size() : at + 5);
  return at == std::string::npos || number != at + 5 ? "" : opengl.substr(number, opengl.find(' ', number) - number);
}

/// Those that it has.
std::vector<std::pair<const char*, int>> numbers_of(const CpuIdentity& cpu) {
  std::vector<std::pair<const char*, int>> known{
      {"family", cpu.family}, {"model", cpu.model}, {"stepping", cpu.stepping}};
  std::erase_if(known, [](const auto& number) { return number.second < 0; });
  return known;
}

}  // namespace

std::string bench_heading(const Machine& machine, const std::string& simd, int threads) {
  return machine.cpu + ", " + std::to_string(machine.cores) + (machine.cores == 1 ? " core at " : " cores at ") +
         formatted(machine.clock_ghz, "%.2f") + " GHz; Trueshade " + kVersion + " (" + kCommit + "), " + simd + ", " +
         std::to_string(threads) + (threads == 1 ? " thread\n" : " threads\n");
}

std::string machine_text(const Machine& machine) {
  const CpuIdentity& cpu = machine.identity;
  std::string text = cpu.vendor;
  for (const auto& [name, value] : numbers_of(cpu)) text += std::string(" ") + name + ' ' + std::to_string(value);
  text += "; " + std::to_string(cpu.cores) + " cores, " + std::to_string(cpu.threads) + " threads";
  if (machine.cores < cpu.threads) text += ", of which this process may use " + std::to_string(machine.cores);
  for (const Cache& cache : machine.caches) text += ", " + cache_text(cache);
  text += "; " + memory_text(machine.memory_mib) + "; " + machine.os + ", " + machine.kernel + "; " + machine.compiler +
          ", " + machine.c_library;
  if (cpu.is_virtual) text += "; virtual" + (machine.hypervisor.empty() ? "" : " (" + machine.hypervisor + ')');
  text += "; " + machine.date + "\nbefore this ran: ";
  const Load& load = machine.load_before;
  text += load.is_known ? "others used " + formatted(load.others, "%.2f") + " of " + std::to_string(load.cpus) +
                              (load.cpus == 1 ? " core" : " cores")
                        : "what others used is not known";
  if (machine.average) text += ", load average " + formatted((*machine.average)[0], "%.2f");
  return text + '\n';
}

std::string reasons_text(const std::vector<std::string>& reasons, const std::string& indent) {
  std::string text;
  for (const std::string& reason : reasons) text += indent + "not to be quoted: " + reason + '\n';
  return text;
}

std::string reasons_json(const std::vector<std::string>& reasons) {
  JsonArray lines;
  for (const std::string& reason : reasons) lines.add_raw(json_string(reason));
  return lines.text();
}

std::string load_json(const Load& load) {
  JsonObject json;
  json.put("seconds", load.seconds).put("cores", load.cpus).put("own", load.own).put("is_known", load.is_known);
  json.put("others", load.others).put("stolen", load.stolen).put("held_back", load.held_back);
  if (load.waited) json.put("waited", *load.waited);
  return json.text();
}

std::string machine_json(const Machine& machine) {
  const CpuIdentity& cpu = machine.identity;
  JsonObject json;
  json.put("cpu", machine.cpu).put("cores", machine.cores).put("clock_ghz", machine.clock_ghz);
  json.put("vendor", cpu.vendor);
  for (const auto& [key, value] : numbers_of(cpu)) json.put(key, value);
  json.put("physical_cores", cpu.cores).put("hardware_threads", cpu.threads);
  JsonArray caches;
  for (const Cache& cache : machine.caches) {
    JsonObject row;
    row.put("level", cache.level).put("type", cache.type).put("kib", cache.kib).put("count", cache.count);
    caches.add_raw(row.text());
  }
  json.put_raw("caches", caches.text()).put("memory_mib", machine.memory_mib);
  json.put("os", machine.os).put("kernel", machine.kernel);
  json.put("compiler", machine.compiler).put("c_library", machine.c_library);
  json.put("virtual", cpu.is_virtual).put("hypervisor", machine.hypervisor);
  if (!machine.opengl.empty()) json.put("opengl", machine.opengl);
  if (const std::string mesa = mesa_version(machine.opengl); !mesa.empty()) json.put("mesa", mesa);
  json.put("date", machine.date).put_raw("load_before", load_json(machine.load_before));
  if (machine.average) {
    JsonArray average;
    for (const double mean : *machine.average) average.add_raw(json_number(mean));
    json.put_raw("load_average", average.text());
  }
  return json.text();
}

}  // namespace trueshade
