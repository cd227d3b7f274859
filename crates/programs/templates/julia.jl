# NAME: a policy of usar. It answers a question with groups: for each task, the ids of its robots.
# It needs the package JSON: julia -e 'using Pkg; Pkg.add("JSON")'
#
# julia NAME.jl --test     asks it the questions of NAME.questions.jsonl

using JSON

"Per role, the robots with more energy take the harder tasks; ties go to the lower id."
function decide(question, options)
    level = findfirst(level -> level["name"] == "energy", question["levels"])
    tasks = question["tasks"]
    hardest_first = sort(collect(eachindex(tasks)); by = task -> -tasks[task]["difficulty"], alg = MergeSort)
    groups = [Int[] for _ in tasks]
    for (role, quota) in enumerate(question["quotas"])
        robots = [robot for robot in question["members"] if robot["role"] == role - 1]
        energy(robot) = something(robot["levels"][level], 0)
        sort!(robots; by = robot -> (-energy(robot), robot["id"]))
        ids = [Int(robot["id"]) for robot in robots]
        for task in hardest_first
            size = quota["members"][task]
            append!(groups[task], ids[1:size])
            ids = ids[size+1:end]
        end
    end
    return groups
end

function send(message)
    println(stdout, JSON.json(message)) # all other prints: println(stderr, ...)
    flush(stdout)
end

function answer()
    options = Dict()
    for line in eachline(stdin)
        message = JSON.parse(line)
        if message["type"] == "hello"
            options = message["options"]
            send(Dict("type" => "hello", "protocol" => 1, "schema_version" => 3,
                      "name" => "NAME", "version" => "0.1", "deterministic" => true))
        elseif message["type"] == "question"
            assignment = Dict("groups" => decide(message["question"], options))
            send(Dict("type" => "decision", "id" => message["id"],
                      "decision" => Dict("assignment" => assignment)))
        else
            return
        end
    end
end

function test()
    lines = readlines(replace(PROGRAM_FILE, r"\.jl$" => "") * ".questions.jsonl")
    for line in lines
        question = JSON.parse(line)
        groups = decide(question, Dict())
        ids = [Int(robot["id"]) for robot in question["members"]]
        @assert length(groups) == length(question["tasks"])
        @assert sort(reduce(vcat, groups)) == sort(ids)
    end
    println(length(lines), " questions answered")
end

"--test" in ARGS ? test() : answer()
