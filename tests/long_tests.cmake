# The longest tests begin first, so that none of them is left for one processor in the end. On busy machines they take
# several times as long.
set_tests_properties(ValidateCommand.PassesOnSmallVolumesAndSaysSoLineByLine
                     MemoryLimit.SparseSmokeIn512CubedTakesLessThanAGibibyteOfHostAndDevice
                     PROPERTIES COST 1000 TIMEOUT 1200)
