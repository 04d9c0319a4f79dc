# The runners of several tests (Unity's generator) in one start of Ruby.
# usage: ruby -r .../unity/auto/generate_test_runner.rb make_runners.rb CONFIG.yml FOLDER TEST.c...
# FOLDER/TEST_runner.h is included at the head of TEST.c. One that comes out as it was is not touched, so that its test is
# not compiled again.
config, folder, *tests = ARGV
tests.each do |test|
  runner = File.join(folder, "#{File.basename(test, '.c')}_runner.h")
  made = "#{runner}.new"
  UnityTestRunnerGenerator.new(config).run(test, made)
  stub = File.read(test).include?('#include "one_fixture.h"') ? "void setUp(void) {}\n" : nil # it has a setUp() of its own
  text = "#pragma GCC system_header\n#{File.read(made).sub(stub.to_s, '')}" # no warnings of the generator's code
  File.write(runner, text) unless File.exist?(runner) && File.read(runner) == text
  File.delete(made)
end
