# The runners of several tests (Unity's generator) in one start of Ruby.
# usage: ruby -r .../unity/auto/generate_test_runner.rb make_runners.rb CONFIG.yml FOLDER TEST.c...
# FOLDER/TEST_runner.h is included at the head of TEST.c. One that comes out as it was is not touched, so that its test is
# not compiled again. A header one_....h that a test includes may have its setUp() and tearDown().
config, folder, *tests = ARGV
tests.each do |test|
  runner = File.join(folder, "#{File.basename(test, '.c')}_runner.h")
  made = "#{runner}.new"
  UnityTestRunnerGenerator.new(config).run(test, made)
  text = "#pragma GCC system_header\n#{File.read(made)}" # no warnings of the generator's code
  header = File.read(test)[/#include "(one_\w+\.h)"/, 1]
  common = header ? File.read(Dir.glob(File.join(__dir__, '**', header)).first) : ''
  %w[setUp tearDown].each do |name|
    text.sub!("void #{name}(void) {}\n", '') if common.include?("void #{name}(void) {")
  end
  File.write(runner, text) unless File.exist?(runner) && File.read(runner) == text
  File.delete(made)
end
