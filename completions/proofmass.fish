# fish completion of proofmass: asks the program itself (apps/proofmass/cli/completion.hpp).

function __proofmass_complete
    set -l typed (commandline -opc)
    set -l word (commandline -ct)
    set -l files
    set -l ending
    set -l prefix
    for line in ($typed[1] __complete $typed[2..-1] "$word" 2>/dev/null)
        switch $line
            case ':files'
                set files yes
            case ':ending *'
                set ending (string replace ':ending ' . -- $line)
            case ':prefix *'
                set prefix (string replace ':prefix ' '' -- $line)
            case ':*'
            case '*'
                printf '%s\n' $line
        end
    end
    test -n "$files"; or return 0
    set -l rest (string sub --start (math (string length -- "$prefix") + 1) -- "$word")
    set -l paths (__fish_complete_path $rest)
    # Those of the ending, if there are any, and the folders.
    if test -n "$ending"; and string match -q -- "*$ending" (string split -f1 \t -- $paths)
        set paths (string match -r -- "^[^\t]*(?:/|\\Q$ending\\E)(?:\t.*)?\$" $paths)
    end
    for path in $paths
        printf '%s%s\n' "$prefix" $path
    end
end

complete --command proofmass --no-files --arguments '(__proofmass_complete)'
